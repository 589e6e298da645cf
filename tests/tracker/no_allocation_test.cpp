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

}  // namespace
}  // namespace nadir::tracker
