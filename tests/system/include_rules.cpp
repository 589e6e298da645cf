#include "tests/system/include_rules.h"

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>
#include <string_view>

namespace nadir::system_test {
namespace {

constexpr std::array<std::string_view, 6> kRooms = {"vision/", "calibration/",    "tracker/",
                                                    "fusion/", "control_client/", "tests/"};

/// What the files whose path starts with `files` may include of the rooms: paths that start with
/// one of `allowed`.
struct Floor {
  std::string_view files;
  std::vector<std::string_view> allowed;
  std::string_view words;
};

/// The first floor that fits a file decides, so exceptions stand before their room.
const std::vector<Floor>& floors() {
  static const std::vector<Floor> kFloors = {
      {"vision/input/", {"vision/input/"}, "the strict readers stand alone"},
      {"vision/", {"vision/"}, "vision knows nobody but itself"},
      {"calibration/program/",
       {"calibration/", "vision/"},
       "nadir-calibrate knows calibration and vision"},
      {"calibration/",
       {"calibration/", "vision/pixel.h", "vision/pixel_scale_grid.h", "vision/frame.h",
        "vision/marker_layout.h", "vision/marker_observation.h", "vision/colour_classes.h",
        "vision/input/"},
       "calibration knows vision's value types and readers"},
      {"fusion/fuse/", {"fusion/", "vision/input/"}, "nadir-fuse knows fusion and the readers"},
      {"fusion/", {"fusion/"}, "fusion knows nobody but itself"},
      {"tracker/wire/",
       {"tracker/wire/", "fusion/planar_pose.h"},
       "the wire knows itself and the planar pose"},
      {"tracker/",
       {"tracker/", "calibration/", "vision/", "fusion/planar_pose.h"},
       "tracker knows calibration, vision and fusion's planar pose"},
      {"control_client/",
       {"control_client/", "fusion/", "tracker/wire/", "vision/input/"},
       "control_client knows fusion, the wire and the readers"},
      {"tests/",
       {"tests/", "vision/", "calibration/", "tracker/", "fusion/", "control_client/"},
       "tests know the rooms"},
  };
  return kFloors;
}

bool starts_with_any(std::string_view text, const std::vector<std::string_view>& starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return text.starts_with(start); });
}

bool is_in_a_room(std::string_view target) {
  return std::any_of(kRooms.begin(), kRooms.end(),
                     [&](std::string_view room) { return target.starts_with(room); });
}

std::optional<std::string> broken_room_rule(std::string_view file, const std::string& target) {
  for (const Floor& floor : floors()) {
    if (!file.starts_with(floor.files)) continue;
    if (starts_with_any(target, floor.allowed)) return std::nullopt;
    return "may not include " + target + ": " + std::string(floor.words);
  }
  return "stands in no room";
}

/// Libraries that a room must do without.
std::optional<std::string> broken_library_rule(std::string_view file, std::string_view target) {
  if (file.starts_with("tests/")) return std::nullopt;
  if (target.starts_with("opencv2/") &&
      starts_with_any(file, {"fusion/", "control_client/", "tracker/wire/", "vision/input/"})) {
    return "may not include OpenCV: the side of the robots does without it";
  }
  if (starts_with_any(target, {"dds/", "ddsc/"}) && !file.starts_with("tracker/wire/")) {
    return "may not include DDS: tracker/wire is the only one who speaks it";
  }
  if (file.starts_with("fusion/") && !file.starts_with("fusion/fuse/")) {
    if (target.find('/') != std::string_view::npos && !target.starts_with("Eigen/")) {
      return "may not include " + std::string(target) + ": fusion's core stands on Eigen alone";
    }
    if (target == "fstream" || target == "filesystem" || target == "iostream") {
      return "may not include " + std::string(target) + ": fusion's core knows no files";
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<IncludeLine> include_lines(const std::string& text) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<IncludeLine> lines;
  std::istringstream stream(text);
  std::string line;
  std::smatch match;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (std::regex_search(line, match, kInclude)) {
      lines.push_back({number, match[1] == "\"", match[2]});
    }
  }
  return lines;
}

std::optional<std::string> broken_rule(const std::string& file, const IncludeLine& include) {
  if (is_in_a_room(include.target)) return broken_room_rule(file, include.target);
  if (!include.quoted) return broken_library_rule(file, include.target);
  // A quoted path outside the rooms is a header that the build makes from a description of
  // messages.
  if (include.target.find("..") == std::string::npos &&
      starts_with_any(file, {"tracker/wire/", "tests/bench/dds_"})) {
    return std::nullopt;
  }
  return "includes \"" + include.target + "\": write the path from the repository root" +
         " (generated message structs never leave tracker/wire)";
}

std::vector<std::string> room_sources(const std::filesystem::path& repository) {
  std::vector<std::string> files;
  for (const std::string_view room : kRooms) {
    const std::filesystem::path folder = repository / room;
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".h" || extension == ".cpp") {
        files.push_back(entry.path().lexically_relative(repository).generic_string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace nadir::system_test
