#pragma once

#include <filesystem>
#include <string>

namespace nadir::vision {

/// The whole file as it is on the disk, without a UTF-8 byte order mark. Throws InputError if it is
/// missing, a folder or not readable.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace nadir::vision
