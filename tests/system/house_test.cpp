// The shape of the repository, and of what `cmake --install` makes of it.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::system_test {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;

/// Tracked paths; empty where this is not a git work tree (an unpacked archive) or git is not
/// there.
std::vector<std::string> tracked_files() {
  std::vector<std::string> files;
  if (!std::filesystem::exists(std::filesystem::path(NADIR_SOURCE_DIR) / ".git")) return files;
  ChildProcess git("git", {"-C", NADIR_SOURCE_DIR, "ls-files"});
  if (git.wait(20s) != 0) return files;
  std::istringstream lines(git.out());
  for (std::string line; std::getline(lines, line);) files.push_back(line);
  return files;
}

TEST(House, HasNothingAtItsTopButTheRooms) {
  const std::set<std::string> allowed = {"CMakeLists.txt", "README.md",   "LICENSE", "run",
                                         "vision",         "calibration", "tracker", "fusion",
                                         "control_client", "data",        "tests"};
  const std::vector<std::string> files = tracked_files();
  if (files.empty())
    GTEST_SKIP() << "SKIPPED, LOUDLY: no git work tree tells tracked files from others; the top "
                    "level is NOT checked";
  for (const std::string& file : files) {
    const std::string first = file.substr(0, file.find('/'));
    EXPECT_TRUE(first.front() == '.' || allowed.contains(first))
        << file << " stands where only the rooms may stand";
  }
}

TEST(House, KeepsCodeOutOfData) {
  const std::set<std::string> code = {".cpp", ".h", ".c", ".py", ".sh", ".cmake"};
  int looked_at = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(NADIR_DATA_DIR)) {
    EXPECT_FALSE(code.contains(entry.path().extension().string())) << entry.path();
    ++looked_at;
  }
  EXPECT_GT(looked_at, 0);
}

TEST(House, HasNoFolderForEverythingAndNothing) {
  const std::set<std::string> vague = {"common", "utils", "util", "core", "misc", "helpers"};
  for (const std::string& file : tracked_files()) {
    for (const auto& part : std::filesystem::path(file).parent_path()) {
      EXPECT_FALSE(vague.contains(part.string())) << file;
    }
  }
}

TEST(Install, ProgramsRunAndDataIsThere) {
  const vision::ScratchFolder prefix;
  ChildProcess install(NADIR_CMAKE, {"--install", NADIR_BUILD_DIR, "--prefix", prefix.path()});
  ASSERT_EQ(install.wait(120s), 0) << install.out() << install.err();

  std::istringstream names(NADIR_PROGRAMS);
  int ran = 0;
  for (std::string name; std::getline(names, name, ','); ++ran) {
    ChildProcess program(prefix.path() / "bin" / name, {"--version"});
    EXPECT_EQ(program.wait(20s), 0) << program.err();
    EXPECT_EQ(program.out(), name + " " NADIR_VERSION "\n");
  }
  EXPECT_GE(ran, 1);
  EXPECT_TRUE(std::filesystem::is_directory(prefix.path() / "share/nadir/layouts"));
}

}  // namespace
}  // namespace nadir::system_test
