#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace nadir::vision {
namespace {

/// Runs the real nadir-render in a folder of its own.
class RenderProgram : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::path(testing::TempDir()) / ("nadir_render_" + name);
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  int run(const std::string& arguments) {
    const std::string command = std::string("'") + NADIR_BIN_DIR + "/nadir-render' " + arguments +
                                " > '" + (folder_ / "out").string() + "' 2> '" +
                                (folder_ / "err").string() + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text_of(const std::string& file) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }
  std::string scene(const std::string& text) const {
    std::ofstream(folder_ / "scene.yaml") << text;
    return "'" + (folder_ / "scene.yaml").string() + "'";
  }
  std::string output() const { return " -o '" + (folder_ / "recording").string() + "'"; }

  std::filesystem::path folder_;
};

TEST_F(RenderProgram, WritesARecordingThatTheSeedRepeats) {
  const std::string demo = std::string("'") + NADIR_DATA_DIR + "/scenes/demo.yaml'";
  ASSERT_EQ(run(demo + output() + " --frames 2 --seed 7"), 0) << text_of("err");
  EXPECT_EQ(text_of("out"), "");
  const std::string first = text_of("recording/frames/000001.png");
  EXPECT_GT(first.size(), 10000U);
  const std::string truth = text_of("recording/truth.jsonl");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 2);
  ASSERT_EQ(run(demo + output() + " --frames 2 --seed 7"), 0);
  EXPECT_EQ(text_of("recording/frames/000001.png"), first);
  ASSERT_EQ(run(demo + output() + " --frames 2 --seed 8"), 0);
  EXPECT_NE(text_of("recording/frames/000001.png"), first);
}

TEST_F(RenderProgram, WrongInputIsOneLineAndExitCodeTwo) {
  EXPECT_EQ(run(scene("camera: {widht_px: 64}\n") + output() + " --frames 1"), 2);
  const std::string line = text_of("err");
  EXPECT_NE(line.find("scene.yaml:1:10"), std::string::npos) << line;
  EXPECT_NE(line.find("width_px"), std::string::npos) << line;
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  EXPECT_EQ(run("absent.yaml" + output() + " --frames 1"), 2);
  EXPECT_NE(text_of("err").find("absent.yaml"), std::string::npos);
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run(scene("frames: 1\n") + output() + " --frames 0"), 2);
}

TEST_F(RenderProgram, AFolderThatCannotBeWrittenIsExitCodeOne) {
  EXPECT_EQ(run(scene("camera: {width_px: 32, height_px: 32}\n") + " -o /dev/null/x --frames 1"),
            1);
  EXPECT_NE(text_of("err"), "");
}

TEST_F(RenderProgram, HelpsWithAnExample) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_NE(text_of("out").find("Example: nadir-render"), std::string::npos);
  EXPECT_EQ(run("--version"), 0);
  EXPECT_NE(text_of("out").find(NADIR_VERSION), std::string::npos);
}

}  // namespace
}  // namespace nadir::vision
