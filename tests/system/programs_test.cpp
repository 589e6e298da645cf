// What every program of nadir promises on its command line, and what it may be linked with.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

namespace nadir::system_test {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;

/// Comma-separated names that the build gives.
std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> list;
  std::istringstream stream(names);
  for (std::string name; std::getline(stream, name, ',');) list.push_back(name);
  return list;
}

std::vector<std::string> programs() { return split(NADIR_PROGRAMS); }

std::filesystem::path program_path(const std::string& name) {
  return std::filesystem::path(NADIR_BIN_DIR) / name;
}

std::ptrdiff_t line_count(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

class Program : public testing::TestWithParam<std::string> {};

TEST_P(Program, HelpShowsAnExample) {
  ChildProcess help(program_path(GetParam()), {"--help"});
  EXPECT_EQ(help.wait(20s), 0) << help.err();
  const std::size_t example = help.out().find("Example");
  ASSERT_NE(example, std::string::npos) << help.out();
  EXPECT_NE(help.out().find(GetParam(), example), std::string::npos) << help.out();
  EXPECT_EQ(help.err(), "");
}

TEST_P(Program, VersionIsThatOfTheProject) {
  ChildProcess version(program_path(GetParam()), {"--version"});
  EXPECT_EQ(version.wait(20s), 0) << version.err();
  EXPECT_EQ(version.out(), GetParam() + " " NADIR_VERSION "\n");
}

TEST_P(Program, UnknownOptionIsOneLineAndExitCodeTwo) {
  ChildProcess wrong(program_path(GetParam()), {"--no-such-option"});
  EXPECT_EQ(wrong.wait(20s), 2);
  EXPECT_EQ(wrong.out(), "");
  EXPECT_EQ(line_count(wrong.err()), 1) << wrong.err();
  EXPECT_TRUE(wrong.err().starts_with(GetParam() + ": ")) << wrong.err();
}

std::string test_name(const testing::TestParamInfo<std::string>& program) {
  std::string name = program.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Program, testing::ValuesIn(programs()), test_name);

/// Names of the shared libraries that a program loads, its libraries' libraries included.
std::string shared_libraries(const std::string& program) {
  ChildProcess ldd("ldd", {program_path(program).string()});
  EXPECT_EQ(ldd.wait(20s), 0) << ldd.err();
  return ldd.out();
}

TEST(Linking, TheRobotsSideLoadsNoOpenCv) {
  const std::vector<std::string> built = programs();
  int looked_at = 0;
  for (const char* name : {"nadir-listen", "nadir-client", "nadir-fuse"}) {
    if (std::find(built.begin(), built.end(), name) == built.end()) continue;
    EXPECT_EQ(shared_libraries(name).find("libopencv"), std::string::npos) << name;
    ++looked_at;
  }
  EXPECT_GE(looked_at, 1);
}

TEST(Linking, TheLookFindsOpenCvWhereItIs) {
  EXPECT_NE(shared_libraries("nadir-render").find("libopencv_core"), std::string::npos);
}

TEST(Linking, NobodyLoadsMoreOfOpenCvThanTheFourModules) {
  for (const std::string& program : programs()) {
    std::istringstream lines(shared_libraries(program));
    for (std::string line; std::getline(lines, line);) {
      if (line.find("libopencv_") == std::string::npos) continue;
      const bool is_needed = line.find("_core.") != std::string::npos ||
                             line.find("_imgproc.") != std::string::npos ||
                             line.find("_imgcodecs.") != std::string::npos ||
                             line.find("_videoio.") != std::string::npos;
      EXPECT_TRUE(is_needed) << program << " loads" << line;
    }
  }
}

}  // namespace
}  // namespace nadir::system_test
