#include "tracker/overlay.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace nadir::tracker {
namespace {

// 4 mm per px, image down is world down.
calibration::PlaneMap plain_map() {
  calibration::PolynomialMap::Parameters parameters;
  parameters.order = 1;
  parameters.scale_px = 250.0;
  parameters.coefficients_m.resize(2, 3);
  parameters.coefficients_m << 0.0, 1.0, 0.0, 0.0, 0.0, -1.0;
  parameters.information_inverse = Eigen::MatrixXd::Zero(3, 3);
  return calibration::PlaneMap(calibration::PolynomialMap(parameters));
}

vision::MarkerLayout layout() {
  vision::MarkerLayout layout;
  layout.centre_radius_m = 0.04;
  layout.teams = {{"blue", vision::Colour::kBlue}};
  layout.outer = {{{0.1, 0.0}, 0.02, vision::Colour::kYellow}};
  return layout;
}

FrameReport robot_at(double u_px, double v_px, double heading_rad) {
  FrameReport report;
  RobotReport robot;
  robot.team = "blue";
  robot.centre_px = {u_px, v_px};
  robot.pose_world_robot = {u_px * 0.004, -v_px * 0.004, heading_rad};
  robot.covariance = Eigen::Vector3d(1e-8, 1e-8, 1e-6).asDiagonal();
  report.robots.push_back(robot);
  return report;
}

double difference(const cv::Mat& picture, const cv::Rect& part, const cv::Scalar& ground) {
  return cv::norm(picture(part), cv::Mat(part.size(), CV_8UC3, ground), cv::NORM_INF);
}

const cv::Scalar kGround(60, 90, 60);

TEST(Overlay, DrawsTheArrowWhereTheRobotPoints) {
  Overlay overlay(plain_map(), {layout()});
  const cv::Mat field(1000, 1200, CV_8UC3, kGround);
  // The circle has a radius of 32 px, the arrow ends at 52 px. Heading up in the world is up in
  // this image.
  const cv::Mat up = overlay.draw(field, robot_at(600.0, 500.0, 1.5707963)).clone();
  ASSERT_EQ(up.size(), field.size());
  EXPECT_GT(difference(up, {590, 450, 20, 14}, kGround), 50.0);
  EXPECT_EQ(difference(up, {640, 490, 12, 20}, kGround), 0.0);
  const cv::Mat right = overlay.draw(field, robot_at(600.0, 500.0, 0.0)).clone();
  EXPECT_GT(difference(right, {640, 490, 12, 20}, kGround), 50.0);
}

TEST(Overlay, LeavesTheGivenPictureAlone) {
  Overlay overlay(plain_map(), {layout()});
  const cv::Mat field(1000, 1200, CV_8UC3, kGround);
  overlay.draw(field, robot_at(600.0, 500.0, 0.0));
  EXPECT_EQ(difference(field, {0, 0, 1200, 1000}, kGround), 0.0);
}

TEST(Overlay, EnlargesSmallPictures) {
  Overlay overlay(plain_map(), {layout()});
  const cv::Mat& picture =
      overlay.draw(cv::Mat(240, 320, CV_8UC3, kGround), robot_at(160.0, 120.0, 0.0));
  EXPECT_EQ(picture.size(), cv::Size(640, 480));
}

TEST(Overlay, StaysInsideOfThePicture) {
  Overlay overlay(plain_map(), {layout()});
  FrameReport report = robot_at(1.0, 1.0, 0.0);
  report.rejected.push_back({{31.0, 23.0}, "a reason that is longer than the picture is wide"});
  for (const cv::Size& size : {cv::Size(32, 24), cv::Size(320, 240), cv::Size(1200, 20)}) {
    EXPECT_FALSE(overlay.draw(cv::Mat(size, CV_8UC3, kGround), report).empty());
  }
}

}  // namespace
}  // namespace nadir::tracker
