#include "tracker/camera_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/tracker/synthetic_setup.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

TEST(CameraPipeline, ReportsAFrameWithoutRobots) {
  SyntheticCamera camera = synthetic_camera("pair_even", 1);
  CameraPipeline pipeline(camera.setup, 640, 480);
  vision::Frame frame;
  frame.number = 17;
  frame.capture_time = camera.renderer.capture_time(17);
  frame.image = cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
  FrameReport report;
  pipeline.process(frame, 12.5, report);
  EXPECT_EQ(report.frame, 17u);
  EXPECT_EQ(report.camera, "synthetic");
  EXPECT_EQ(report.capture_ns, frame.capture_time.time_since_epoch().count());
  EXPECT_TRUE(report.robots.empty());
  EXPECT_EQ(report.stages.read_us, 12.5);
  EXPECT_GE(report.stages.total_us, report.stages.detect_us + report.stages.map_us);
}

TEST(CameraPipeline, TakesTheFloorOfAlignmentFromItsSetup) {
  SyntheticCamera camera = synthetic_camera("pair_even", 1);
  const auto report_with = [&](std::optional<double> floor_px) {
    PipelineSetup setup = camera.setup;
    setup.alignment_floor_px = floor_px;
    CameraPipeline pipeline(setup, 640, 480);
    FrameReport report;
    pipeline.process(rendered_frame(camera.renderer, 0), 0.0, report);
    return report;
  };
  const FrameReport calm = report_with({});
  const FrameReport shaken = report_with(0.1);
  ASSERT_FALSE(calm.robots.empty());
  ASSERT_EQ(shaken.robots.size(), calm.robots.size());
  for (std::size_t i = 0; i < calm.robots.size(); ++i) {
    EXPECT_TRUE(calm.robots[i].aligned);
    // Two discs of 0.1 px each, 60 mm apart.
    const double m_per_px =
        camera.setup.calibration.map.jacobian_m_per_px(calm.robots[i].centre_px).col(0).norm();
    const double added_rad2 = shaken.robots[i].covariance(2, 2) - calm.robots[i].covariance(2, 2);
    EXPECT_NEAR(std::sqrt(added_rad2) / (std::sqrt(2.0) * 0.1 * m_per_px / 0.06), 1.0, 0.1);
  }
}

TEST(CameraPipeline, RefusesFramesOfAnotherSizeThanTheCalibrations) {
  const SyntheticCamera camera = synthetic_camera("pair_even", 1);
  EXPECT_THROW(CameraPipeline(camera.setup, 1280, 960), vision::InputError);
}

TEST(CameraPipeline, RefusesAFrameOfAnotherSizeThanTheFirst) {
  const SyntheticCamera camera = synthetic_camera("pair_even", 1);
  CameraPipeline pipeline(camera.setup, 640, 480);
  vision::Frame frame;
  frame.image = cv::Mat(240, 320, CV_8UC3, cv::Scalar(0, 0, 0));
  FrameReport report;
  EXPECT_THROW(pipeline.process(frame, 0.0, report), vision::InputError);
}

TEST(CameraPipeline, RefusesTwoTeamsOfOneName) {
  SyntheticCamera camera = synthetic_camera("pair_even", 1);
  camera.setup.layouts.push_back(camera.setup.layouts[0]);
  EXPECT_THROW(CameraPipeline(camera.setup, 640, 480), vision::InputError);
}

// Two layouts that see the same robots: each disc is reported once, for the layout with more discs.
TEST(CameraPipeline, ReportsARobotOfTwoLayoutsOnce) {
  SyntheticCamera camera = synthetic_camera("league_even", 2);
  vision::MarkerLayout twin = camera.setup.layouts[0];
  twin.name = "twin";
  for (vision::Team& team : twin.teams) team.name = "twin " + team.name;
  camera.setup.layouts.push_back(twin);
  CameraPipeline pipeline(camera.setup, 1280, 1024);
  FrameReport report;
  pipeline.process(rendered_frame(camera.renderer, 0), 0.0, report);
  EXPECT_EQ(report.robots.size(), camera.renderer.truth(0).size());
  const auto shared = std::ranges::count_if(report.rejected, [](const RejectionReport& rejection) {
    return std::string(rejection.reason) == reject_reason_text(vision::RejectReason::kSharedDisc);
  });
  EXPECT_EQ(static_cast<std::size_t>(shared), report.robots.size());
}

}  // namespace
}  // namespace nadir::tracker
