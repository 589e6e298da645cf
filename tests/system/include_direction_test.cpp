// Includes point against the flow of the data; the rules are in include_rules.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/system/include_rules.h"

namespace nadir::system_test {
namespace {

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

struct Example {
  const char* file;
  const char* line;
};

std::optional<std::string> rule_broken_by(const Example& example) {
  const std::vector<IncludeLine> lines = include_lines(example.line);
  EXPECT_EQ(lines.size(), 1U) << example.line;
  return lines.empty() ? std::nullopt : broken_rule(example.file, lines.front());
}

TEST(IncludeDirection, EverySourceFileKeepsToItsFloor) {
  const std::filesystem::path repository = NADIR_SOURCE_DIR;
  const std::vector<std::string> files = room_sources(repository);
  for (const char* expected : {"vision/pixel.h", "fusion/planar_pose.h", "calibration/plane_map.h",
                               "tracker/pose_report.h", "tests/system/include_rules.cpp"}) {
    EXPECT_NE(std::find(files.begin(), files.end(), expected), files.end())
        << expected << " was not read";
  }
  for (const std::string& file : files) {
    for (const IncludeLine& include : include_lines(read_text(repository / file))) {
      const std::optional<std::string> rule = broken_rule(file, include);
      EXPECT_FALSE(rule) << file << ":" << include.line << ": " << rule.value_or("");
    }
  }
}

TEST(IncludeDirection, FindsEveryIncludeLineOfAText) {
  const std::vector<IncludeLine> lines = include_lines(
      "#pragma once\n"
      "  #  include <vector>  // growing\n"
      "// #include \"vision/frame.h\"\n"
      "#include \"vision/pixel.h\"\r\n");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].line, 2);
  EXPECT_EQ(lines[0].target, "vector");
  EXPECT_FALSE(lines[0].quoted);
  EXPECT_EQ(lines[1].line, 4);
  EXPECT_EQ(lines[1].target, "vision/pixel.h");
  EXPECT_TRUE(lines[1].quoted);
}

class WrongInclude : public testing::TestWithParam<Example> {};

TEST_P(WrongInclude, IsNamedWithItsRule) {
  const std::optional<std::string> rule = rule_broken_by(GetParam());
  EXPECT_TRUE(rule) << GetParam().file << " was allowed " << GetParam().line;
}

INSTANTIATE_TEST_SUITE_P(
    Examples, WrongInclude,
    testing::Values(Example{"vision/frame.h", "#include \"calibration/plane_map.h\""},
                    Example{"vision/frame.h", "#include <fusion/planar_pose.h>"},
                    Example{"vision/input/csv_table.h", "#include \"vision/frame.h\""},
                    Example{"vision/input/strict_yaml.cpp", "#include <opencv2/core.hpp>"},
                    Example{"vision/frame.h", "#include <dds/dds.h>"},
                    Example{"calibration/fit/fit.cpp", "#include \"fusion/planar_pose.h\""},
                    Example{"calibration/fit/fit.cpp", "#include \"tracker/pose_report.h\""},
                    Example{"calibration/fit/fit.cpp",
                            "#include \"vision/disc_pattern_detector.h\""},
                    Example{"fusion/gate.cpp", "#include \"tracker/wire/pose_reader.h\""},
                    Example{"fusion/gate.cpp", "#include \"vision/pixel.h\""},
                    Example{"fusion/gate.cpp", "#include \"vision/input/csv_table.h\""},
                    Example{"fusion/gate.cpp", "#include <opencv2/core.hpp>"},
                    Example{"fusion/gate.cpp", "#include <dds/dds.h>"},
                    Example{"fusion/gate.cpp", "#include <fmt/format.h>"},
                    Example{"fusion/gate.cpp", "#include <fstream>"},
                    Example{"tracker/pose_log.cpp", "#include \"control_client/trajectory.h\""},
                    Example{"tracker/pose_log.cpp", "#include \"fusion/gate.h\""},
                    Example{"tracker/pose_log.cpp", "#include \"robot_pose.h\""},
                    Example{"tracker/pose_log.cpp", "#include <dds/dds.h>"},
                    Example{"tracker/wire/topics.h", "#include \"tracker/pose_report.h\""},
                    Example{"tracker/wire/topics.h", "#include \"../pose_report.h\""},
                    Example{"tracker/wire/topics.h", "#include <opencv2/core.hpp>"},
                    Example{"control_client/outer_loop.cpp", "#include \"tracker/pose_report.h\""},
                    Example{"control_client/outer_loop.cpp", "#include \"vision/frame.h\""},
                    Example{"control_client/outer_loop.cpp", "#include <opencv2/core.hpp>"},
                    Example{"elsewhere/main.cpp", "#include \"vision/frame.h\""}));

class RightInclude : public testing::TestWithParam<Example> {};

TEST_P(RightInclude, IsAllowed) {
  const std::optional<std::string> rule = rule_broken_by(GetParam());
  EXPECT_FALSE(rule) << GetParam().file << " " << GetParam().line << ": " << rule.value_or("");
}

INSTANTIATE_TEST_SUITE_P(
    Examples, RightInclude,
    testing::Values(Example{"vision/frame.h", "#include <opencv2/core.hpp>"},
                    Example{"calibration/fit/fit.cpp", "#include \"vision/pixel.h\""},
                    Example{"calibration/program/calibrate_main.cpp",
                            "#include \"vision/disc_pattern_detector.h\""},
                    Example{"fusion/gate.cpp", "#include <Eigen/Cholesky>"},
                    Example{"fusion/fuse/fuse_main.cpp", "#include \"vision/input/csv_table.h\""},
                    Example{"tracker/pose_log.cpp", "#include \"calibration/plane_map.h\""},
                    Example{"tracker/pose_log.cpp", "#include \"fusion/planar_pose.h\""},
                    Example{"tracker/wire/pose_codec.cpp", "#include \"robot_pose.h\""},
                    Example{"tracker/wire/dds_entities.h", "#include <dds/dds.h>"},
                    Example{"control_client/client_main.cpp",
                            "#include \"tracker/wire/pose_reader.h\""},
                    Example{"tests/tracker/wire_test.cpp", "#include <opencv2/core.hpp>"}));

}  // namespace
}  // namespace nadir::system_test
