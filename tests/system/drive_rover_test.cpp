// The rover over DDS: nadir-tracker sees it, nadir-client drives it, its firmware pushes.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "control_client/drive/drive_errors.h"
#include "tests/system/drive_loop.h"

namespace nadir::system_test {
namespace {

using test::ChildProcess;

constexpr std::chrono::seconds kPatience{60};
#ifdef __SANITIZE_ADDRESS__  // every process is many times slower then
constexpr double kFused_m = 0.050;
constexpr double kFollowed_m = 0.100;
#else
constexpr double kFused_m = 0.010;
constexpr double kFollowed_m = 0.040;
#endif

TEST(DriveRover, FollowsACircleByTheTrackersPoses) {
  const DriveLoop loop;
  ChildProcess tracker = loop.tracker();
  const std::filesystem::path robots = std::filesystem::path(NADIR_DATA_DIR) / "robots";
  ChildProcess drive = loop.drive(
      "circle", 8.0, {"--robot-type", "rover", "--robot-file", (robots / "rover.yaml").string()});
  ASSERT_EQ(drive.wait(kPatience), 0) << drive.err() << tracker.err();
  const auto errors = control_client::measure_drive(loop.record());
  EXPECT_LT(errors.fused.position_rms_m, kFused_m);
  EXPECT_LT(errors.fused.heading_rms_rad, 0.06);
  EXPECT_LT(errors.tracking.position_rms_m, kFollowed_m);
  EXPECT_GT(errors.tracking.position_rms_m, 0.0) << "it never came onto its trajectory";
  tracker.signal(SIGTERM);
  EXPECT_EQ(tracker.wait(kPatience), 0) << tracker.err();
}

TEST(DriveRover, AFileOfAnotherTypeIsRefused) {
  const DriveLoop loop;
  const std::filesystem::path robots = std::filesystem::path(NADIR_DATA_DIR) / "robots";
  ChildProcess drive = loop.drive(
      "circle", 8.0, {"--robot-type", "rover", "--robot-file", (robots / "omni3.yaml").string()});
  EXPECT_EQ(drive.wait(kPatience), 2);
  EXPECT_NE(drive.err().find("omnidirectional, not rover"), std::string::npos) << drive.err();
}

}  // namespace
}  // namespace nadir::system_test
