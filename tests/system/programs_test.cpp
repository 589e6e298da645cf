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

/// Names of the shared libraries that a program or library loads, its libraries' libraries
/// included.
std::string shared_libraries(const std::filesystem::path& file) {
  ChildProcess ldd("ldd", {file.string()});
  EXPECT_EQ(ldd.wait(20s), 0) << ldd.err();
  return ldd.out();
}

void expect_of_opencv_only(const std::filesystem::path& file,
                           const std::vector<std::string>& modules) {
  std::istringstream lines(shared_libraries(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("libopencv_") == std::string::npos) continue;
    EXPECT_TRUE(std::ranges::any_of(modules,
                                    [&](const std::string& module) {
                                      return line.find("libopencv_" + module + ".") !=
                                             std::string::npos;
                                    }))
        << file << " loads" << line;
  }
}

TEST(Linking, TheRobotsSideLoadsNoOpenCv) {
  const std::vector<std::string> built = programs();
  int looked_at = 0;
  for (const char* name : {"nadir-listen", "nadir-client", "nadir-fuse"}) {
    if (std::find(built.begin(), built.end(), name) == built.end()) continue;
    EXPECT_EQ(shared_libraries(program_path(name)).find("libopencv"), std::string::npos) << name;
    ++looked_at;
  }
  EXPECT_GE(looked_at, 1);
}

TEST(Linking, TheLookFindsOpenCvWhereItIs) {
  EXPECT_NE(shared_libraries(program_path("nadir-render")).find("libopencv_core"),
            std::string::npos);
}

// Readers of pictures and videos bring two hundred libraries: a tracker that was killed would be
// away for a fifth of a second longer.
TEST(Linking, NoProgramLoadsPictureReadersBeforeItNeedsThem) {
  for (const std::string& program : programs()) {
    expect_of_opencv_only(program_path(program), {"core", "imgproc"});
  }
}

TEST(Linking, PictureReadersAreALibraryOfTheirOwn) {
  const std::filesystem::path library =
      std::filesystem::path(NADIR_BIN_DIR).parent_path() / "lib" / "libnadir_codecs.so";
  EXPECT_NE(shared_libraries(library).find("libopencv_imgcodecs"), std::string::npos);
  expect_of_opencv_only(library, {"core", "imgproc", "imgcodecs", "videoio"});
}

}  // namespace
}  // namespace nadir::system_test
