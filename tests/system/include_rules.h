#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nadir::system_test {

/// One #include line of a source file.
struct IncludeLine {
  int line = 0;         ///< from 1
  bool quoted = false;  ///< "..." and not <...>
  std::string target;   ///< what stands between the quotes or brackets
};

/// The #include lines of C++ text, in order. Lines in comments that start with // do not count.
std::vector<IncludeLine> include_lines(const std::string& text);

/// The rule of the house that `file` (a path from the repository root, such as "fusion/gate.h")
/// breaks with this include, in words for a person; nothing when the include is allowed.
std::optional<std::string> broken_rule(const std::string& file, const IncludeLine& include);

/// The .h and .cpp files of all rooms, as paths from `repository`, sorted.
std::vector<std::string> room_sources(const std::filesystem::path& repository);

}  // namespace nadir::system_test
