#include "vision/input/number_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace nadir::vision {
namespace {

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  // from_chars knows no plus sign; one is allowed, two or "+-" are not.
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, number);
  if (code != std::errc{} || stop != end) return std::nullopt;
  return number;
}

}  // namespace

std::optional<double> number_from_text(std::string_view text) {
  const std::optional<double> number = parse<double>(text);
  if (number && !std::isfinite(*number)) return std::nullopt;
  return number;
}

std::optional<long long> integer_from_text(std::string_view text) { return parse<long long>(text); }

std::string text_from_number(double number) {
  std::array<char, 32> text;
  const auto [stop, code] = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), stop};
}

}  // namespace nadir::vision
