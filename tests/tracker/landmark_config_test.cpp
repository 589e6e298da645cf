// Landmarks from the configuration to the warning, with the program on the bundled clip, in which
// yellow 12 stands.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "tests/support/child_process.h"
#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"
#include "tracker/tracker_config.h"

namespace nadir::tracker {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string config_with(const std::string& landmarks) {
  const std::string data = NADIR_DATA_DIR;
  return "publish: false\ncameras:\n  - name: demo\n    source: " + data +
         "/clips/demo/frames\n    calibration: " + data +
         "/calibrations/demo.yaml\n    layouts: [" + data + "/layouts/league.yaml]\n" + landmarks;
}

/// What the tracker says on stderr, and its exit code.
std::pair<int, std::string> run_with(const std::string& landmarks) {
  const vision::ScratchFolder folder;
  test::ChildProcess tracker(std::filesystem::path(NADIR_BIN_DIR) / "nadir-tracker",
                             {"--config", folder.write("tracker.yaml", config_with(landmarks))});
  const auto code = tracker.wait(std::chrono::seconds(60));
  return {code.value_or(-1), tracker.err()};
}

TEST(LandmarkConfig, IsReadAndPrinted) {
  const vision::ScratchFolder folder;
  const TrackerConfig config = load_tracker_config(folder.write(
      "tracker.yaml", config_with("    landmarks:\n      - {team: yellow, id: 12, x_m: -0.85, y_m: "
                                  "0.45}\n      - {team: blue, x_m: 1, y_m: 2}\n")));
  ASSERT_EQ(config.cameras[0].landmarks.size(), 2U);
  EXPECT_EQ(config.cameras[0].landmarks[0].camera, "demo");
  EXPECT_EQ(config.cameras[0].landmarks[0].id, 12);
  EXPECT_EQ(config.cameras[0].landmarks[1].id, -1);
  EXPECT_EQ(config.cameras[0].landmarks[1].place_m, Eigen::Vector2d(1.0, 2.0));
  const std::string printed = to_yaml(config);
  EXPECT_EQ(to_yaml(load_tracker_config(folder.write("again.yaml", printed))), printed);
  EXPECT_THAT(
      vision::input_error_line([&] {
        load_tracker_config(folder.write(
            "bad.yaml", config_with("    landmarks:\n      - {team: blue, x: 1, y_m: 2}\n")));
      }),
      HasSubstr("bad.yaml:8:"));
}

TEST(LandmarkConfig, ARobotAtItsPlaceIsNoNews) {
  const auto [code, said] =
      run_with("    landmarks: [{team: yellow, id: 12, x_m: -0.85, y_m: 0.45}]\n");
  EXPECT_EQ(code, 0) << said;
  EXPECT_THAT(said, Not(HasSubstr("landmark")));
}

TEST(LandmarkConfig, AKnockedCameraIsTold) {
  // Surveyed 20 mm from where the camera now shows it.
  const auto [code, said] =
      run_with("    landmarks: [{team: yellow, id: 12, x_m: -0.87, y_m: 0.45}]\n");
  EXPECT_EQ(code, 0) << said;
  EXPECT_THAT(said, testing::ContainsRegex(
                        "demo: landmark yellow 12 seems to have moved by [+](19|20)[.]"));
  EXPECT_THAT(said, HasSubstr("was the camera knocked?"));
}

TEST(LandmarkConfig, RefusesATeamThatNoLayoutHas) {
  const auto [code, said] = run_with("    landmarks: [{team: red, x_m: 0, y_m: 0}]\n");
  EXPECT_EQ(code, 2);
  EXPECT_THAT(said, HasSubstr("a landmark is of team 'red', which no layout of the camera has; "
                              "choose one of yellow, blue"));
}

}  // namespace
}  // namespace nadir::tracker
