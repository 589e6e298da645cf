#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nadir::vision {

/// The whole file as it is on the disk, without a UTF-8 byte order mark. Throws InputError if it is
/// missing, a folder or not readable.
std::string read_text_file(const std::filesystem::path& file);

/// Writes a whole file; "-" is stdout. Throws InputError where it cannot be written,
/// std::runtime_error if that is stdout.
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace nadir::vision
