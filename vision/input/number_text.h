#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace nadir::vision {

/// The number that the whole text spells in decimal notation, or nothing. Never infinite, never
/// NaN; the locale does not matter.
std::optional<double> number_from_text(std::string_view text);

/// The same for whole numbers that fit 64 bits.
std::optional<long long> integer_from_text(std::string_view text);

/// Shortest decimal text that reads back as the same number.
std::string text_from_number(double number);

}  // namespace nadir::vision
