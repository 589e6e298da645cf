// In a program of its own, as it counts every allocation of the process.

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/tracker/synthetic_setup.h"
#include "tracker/pose_log.h"

namespace nadir::tracker {
namespace {

TEST(NoAllocation, CounterCounts) {
  const long before = test::allocations();
  const std::vector<int> numbers(100);
  EXPECT_EQ(test::allocations() - before, 1) << numbers.size();
}

TEST(NoAllocation, FromFrameToReportAndJsonAfterStartUp) {
  for (const char* scene : {"league_even", "pair_even"}) {
    SyntheticCamera camera = synthetic_camera(scene, 3);
    CameraPipeline pipeline(camera.setup, camera.renderer.camera().width_px(),
                            camera.renderer.camera().height_px());
    std::vector<vision::Frame> frames;
    for (std::uint64_t k = 0; k < 12; ++k) frames.push_back(rendered_frame(camera.renderer, k));
    FrameReport report;
    fmt::memory_buffer line;
    const auto work = [&](const vision::Frame& frame) {
      pipeline.process(frame, 0.0, report);
      line.clear();
      append_json(report, line);
    };
    for (const vision::Frame& frame : frames) work(frame);
    const long before = test::allocations();
    for (const vision::Frame& frame : frames) work(frame);
    EXPECT_EQ(test::allocations() - before, 0) << scene;
  }
}

// Their robots turn to and fro. The detector itself, which looks for newcomers where there is
// contrast, is libapriltag's and allocates: here nothing has contrast but tags that are followed.
TEST(NoAllocation, TagsThatAreFollowedFromFrameToReport) {
  constexpr int kPictures = 12;
  constexpr int kWarmUp = 70;  // with a look for the mosaic
  constexpr int kFrames = 70;  // with another
  SyntheticCamera camera = synthetic_camera("tags_even", 3);
  CameraPipeline pipeline(camera.setup, camera.renderer.camera().width_px(),
                          camera.renderer.camera().height_px());
  std::vector<vision::RobotPlacement> robots = camera.renderer.placements(0);
  std::vector<vision::Frame> frames(kPictures);
  for (vision::Frame& frame : frames) {
    for (vision::RobotPlacement& robot : robots) robot.motion.heading_rad += 0.01;
    camera.renderer.render_robots(0, robots, frame.image);
  }
  FrameReport report;
  const auto work = [&](int number) {
    constexpr int kThereAndBack = 2 * kPictures - 2;
    const int place = number % kThereAndBack;
    vision::Frame& frame =
        frames[static_cast<std::size_t>(place < kPictures ? place : kThereAndBack - place)];
    frame.number = static_cast<std::uint64_t>(number);
    frame.capture_time = camera.renderer.capture_time(frame.number);
    pipeline.process(frame, 0.0, report);
  };
  for (int k = 0; k < kWarmUp; ++k) work(k);
  const long before = test::allocations();
  for (int k = kWarmUp; k < kWarmUp + kFrames; ++k) {
    work(k);
    ASSERT_EQ(report.robots.size(), robots.size()) << k;
  }
  EXPECT_EQ(test::allocations() - before, 0);
}

}  // namespace
}  // namespace nadir::tracker
