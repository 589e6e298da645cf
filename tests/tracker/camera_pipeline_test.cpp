#include "tracker/camera_pipeline.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/tracker/synthetic_setup.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

// What a run over a scene's random frames comes to.
struct Score {
  int robots = 0;          // there were so many
  int right = 0;           // found, with the right team and number
  int wrong = 0;           // reported, and no such robot is within 5 cm
  double error_px2 = 0.0;  // sums over the right ones
  double error_heading_rad2 = 0.0;
  double nees = 0.0;

  double error_px() const { return std::sqrt(error_px2 / (2.0 * right)); }  // RMS per axis
  double error_heading_rad() const { return std::sqrt(error_heading_rad2 / right); }
};

Score run(const std::string& scene, int frames) {
  SyntheticCamera camera = synthetic_camera(scene, 5);
  const bool anonymous = camera.setup.layouts[0].is_anonymous();
  CameraPipeline pipeline(camera.setup, camera.renderer.camera().width_px(),
                          camera.renderer.camera().height_px());
  Score score;
  FrameReport report;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    pipeline.process(rendered_frame(camera.renderer, number), 0.0, report);
    const auto truth = camera.renderer.truth(number);
    score.robots += static_cast<int>(truth.size());
    for (const RobotReport& robot : report.robots) {
      const auto match = std::ranges::find_if(truth, [&](const vision::RobotTruth& one) {
        const Eigen::Vector2d away =
            robot.pose_world_robot.position_m() - Eigen::Vector2d(one.x_m, one.y_m);
        return away.norm() < 0.05 && one.team == robot.team && (anonymous || one.id == robot.id);
      });
      if (match == truth.end()) {
        ++score.wrong;
        continue;
      }
      ++score.right;
      const Eigen::Vector3d error = fusion::pose_difference(
          robot.pose_world_robot, {match->x_m, match->y_m, match->heading_rad});
      score.error_px2 +=
          (robot.centre_px - vision::PixelPoint(match->u_px, match->v_px)).squaredNorm();
      score.error_heading_rad2 += error.z() * error.z();
      score.nees += error.dot(robot.covariance.inverse() * error);
    }
  }
  score.nees /= std::max(1, score.right);
  return score;
}

class PipelineOnScenes : public testing::TestWithParam<const char*> {};

TEST_P(PipelineOnScenes, FindsAndNamesEveryRobot) {
  const std::string scene = GetParam();
  const Score score = run(scene, 40);
  RecordProperty("centre_error_px", std::to_string(score.error_px()));
  RecordProperty("heading_error_deg", std::to_string(score.error_heading_rad() * 180.0 / M_PI));
  RecordProperty("nees", std::to_string(score.nees));
  std::printf("%s: centre %.4f px, heading %.3f deg, NEES %.2f\n", scene.c_str(), score.error_px(),
              score.error_heading_rad() * 180.0 / M_PI, score.nees);
  EXPECT_GE(score.right, 0.99 * score.robots);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_LT(score.error_px(), 0.06);
  // 3 is ideal. Not too small a covariance above all: 4.5 is the limit.
  EXPECT_GT(score.nees, 2.0);
  EXPECT_LT(score.nees, 4.5);
}

INSTANTIATE_TEST_SUITE_P(FourLights, PipelineOnScenes,
                         testing::Values("league_even", "league_bayer", "league_dim_warm",
                                         "league_shadow", "pair_even", "pair_bayer",
                                         "pair_dim_warm", "pair_shadow"),
                         [](const auto& test) { return std::string(test.param); });

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
