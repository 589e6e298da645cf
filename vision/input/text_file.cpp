#include "vision/input/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "vision/input/input_error.h"

namespace nadir::vision {

std::string read_text_file(const std::filesystem::path& file) {
  const InputPlace place{file.string()};
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) {
    throw InputError(place, "is a folder, not a file", "name a file in it");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    const std::string cause = errno != 0 ? std::strerror(errno) : "unknown reason";
    throw InputError(place, "cannot be opened: " + cause, "check the path and the permissions");
  }
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw InputError(place, "cannot be read to its end", "check the disk");
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  if (file == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw std::runtime_error("stdout cannot be written");
    return;
  }
  std::ofstream stream(file, std::ios::binary);
  stream << text << std::flush;
  if (!stream) {
    throw InputError({file.string()}, "cannot be written", "check the folder and its rights");
  }
}

}  // namespace nadir::vision
