// A real photograph of a league field in daylight, with balls, goals, clutter and people's feet in
// the picture. Made by others, so it is not part of nadir: the test reads it from beside the
// checkout and is skipped without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "calibration/field_points.h"
#include "calibration/fit/fit.h"
#include "fusion/planar_pose.h"
#include "tracker/camera_pipeline.h"

namespace nadir {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(NADIR_REAL_DIR) / "ssl";
constexpr double kHeadingTolerance_deg = 10.0;
constexpr double kCentreTolerance_px = 3.0;  // the truth was read by eye, good to about 1 px

struct TrueRobot {
  int id;
  double u_px;
  double v_px;
  double octant_deg;  // of the front, in the world: image x to the right, y up
};

// The truth file names one of eight directions; they are good to half of their 45 degrees.
constexpr double kOctantTolerance_deg = 22.5;

double octant_from_words(const std::string& front) {
  const std::map<std::string, double> degrees = {
      {"right", 0},  {"upper right", 45},  {"up", 90},    {"upper left", 135},
      {"left", 180}, {"lower left", -135}, {"down", -90}, {"lower right", -45}};
  return degrees.at(front);
}

// Normal of the flat front's edge, read off the enlarged photograph by eye, good to about 5
// degrees.
const std::map<int, double> kFlatFront_deg = {{0, -43}, {1, -52}, {2, 77},
                                              {4, 78},  {5, -85}, {6, 139}};

std::vector<TrueRobot> read_truth() {
  const auto json = nlohmann::json::parse(std::ifstream(kFolder / "field_daylight.truth.json"));
  std::vector<TrueRobot> truth;
  for (const auto& robot : json.at("robots")) {
    truth.push_back(
        {robot.at("id"), robot.at("u_px"), robot.at("v_px"), octant_from_words(robot.at("front"))});
  }
  return truth;
}

tracker::PipelineSetup setup_at_height(double height_m) {
  const auto points = calibration::load_field_points(kFolder / "points.csv");
  calibration::Calibration calibration{calibration::fit_polynomial2(points, {}).map};
  calibration.points_box = calibration::pixel_box(points);
  calibration.height_m = height_m;
  return {
      .camera = "photo",
      .calibration = calibration,
      .calibration_file = kFolder / "points.csv",
      .layouts = {vision::load_marker_layout(fs::path(NADIR_DATA_DIR) / "layouts/league.yaml")}};
}

tracker::CameraPipeline pipeline_for(const cv::Mat& image) {
  return {setup_at_height(0.0), image.cols, image.rows};
}

double difference_deg(double a_deg, double b_deg) {
  return fusion::wrap_angle((a_deg - b_deg) * M_PI / 180.0) * 180.0 / M_PI;
}

void expect_all_six(const cv::Mat& image) {
  tracker::CameraPipeline pipeline = pipeline_for(image);
  vision::Frame frame;
  frame.image = image;
  tracker::FrameReport report;
  pipeline.process(frame, 0.0, report);
  const std::vector<TrueRobot> truth = read_truth();
  EXPECT_EQ(report.robots.size(), truth.size());
  for (const TrueRobot& robot : truth) {
    const auto found = std::ranges::find_if(report.robots, [&](const auto& each) {
      return std::hypot(each.centre_px.x() - robot.u_px, each.centre_px.y() - robot.v_px) <
             kCentreTolerance_px;
    });
    ASSERT_NE(found, report.robots.end()) << "robot " << robot.id << " was not found";
    EXPECT_EQ(found->id, robot.id);
    EXPECT_EQ(found->team, "blue");
    const double heading_deg = found->pose_world_robot.heading_rad * 180.0 / M_PI;
    const double error_deg = difference_deg(heading_deg, kFlatFront_deg.at(robot.id));
    std::printf("robot %d: heading %+.1f deg from the flat front as read by eye, confidence %.2f\n",
                robot.id, error_deg, found->confidence);
    EXPECT_LE(std::abs(error_deg), kHeadingTolerance_deg) << "robot " << robot.id;
    EXPECT_LE(std::abs(difference_deg(heading_deg, robot.octant_deg)), kOctantTolerance_deg);
  }
}

// Gains of blue and red, as another colour temperature brings them.
cv::Mat tinted(const cv::Mat& image, double blue, double red) {
  cv::Mat result;
  cv::multiply(image, cv::Scalar(blue, 1.0, red), result);
  return result;
}

class RealPhotograph : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path file = kFolder / "field_daylight.jpg";
    if (!fs::exists(file)) {
      GTEST_SKIP() << "SKIPPED, LOUDLY: the real photograph " << file
                   << " is not on this machine; detection in real light is NOT checked";
    }
    image_ = cv::imread(file.string());
    ASSERT_FALSE(image_.empty());
  }
  cv::Mat image_;
};

TEST_F(RealPhotograph, AllSixRobotsInDaylight) { expect_all_six(image_); }

TEST_F(RealPhotograph, AllSixRobotsAtHalfTheBrightness) { expect_all_six(image_ * 0.5); }

TEST_F(RealPhotograph, AllSixRobotsInWarmLight) { expect_all_six(tinted(image_, 0.8, 1.2)); }

TEST_F(RealPhotograph, AllSixRobotsInColdLight) { expect_all_six(tinted(image_, 1.2, 0.8)); }

TEST_F(RealPhotograph, AllSixRobotsAtJpegQuality60) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image_, bytes, {cv::IMWRITE_JPEG_QUALITY, 60});
  expect_all_six(cv::imdecode(bytes, cv::IMREAD_COLOR));
}

TEST_F(RealPhotograph, AllSixRobotsHalfAsBrightWarmAndCompressedAtOnce) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", tinted(image_ * 0.5, 0.8, 1.2), bytes, {cv::IMWRITE_JPEG_QUALITY, 60});
  expect_all_six(cv::imdecode(bytes, cv::IMREAD_COLOR));
}

// Without truth this much can be asked: poses aligned with the pixels must scatter less under noise
// of a sensor than they say of themselves.
TEST_F(RealPhotograph, NoiseMovesAlignedRobotsLessThanTheirCovarianceSays) {
  constexpr int kKnown = 40;  // looks until the camera is learnt
  constexpr int kNoisy = 30;
  const double marks_height_m =
      vision::load_marker_layout(fs::path(NADIR_DATA_DIR) / "layouts/league.yaml").height_m;
  tracker::CameraPipeline pipeline(setup_at_height(marks_height_m), image_.cols, image_.rows);
  struct Poses {
    std::vector<Eigen::Vector3d> seen;
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  };
  std::map<int, Poses> robots;
  cv::RNG random(3);
  cv::Mat noise(image_.size(), CV_16SC3);
  vision::Frame frame;
  tracker::FrameReport report;
  for (int i = 0; i < kKnown + kNoisy; ++i) {
    random.fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
    cv::add(image_, noise, frame.image, cv::noArray(), CV_8U);
    frame.number = static_cast<std::uint64_t>(i);
    frame.capture_time = vision::CaptureTime(std::chrono::milliseconds(20 * i));
    pipeline.process(frame, 0.0, report);
    if (i < kKnown) continue;
    for (const tracker::RobotReport& robot : report.robots) {
      if (!robot.aligned) continue;
      const fusion::PlanarPose& pose = robot.pose_world_robot;
      robots[robot.id].seen.emplace_back(pose.x_m, pose.y_m, pose.heading_rad);
      robots[robot.id].variance += robot.covariance.diagonal();
    }
  }
  int mostly_aligned = 0;
  for (const auto& [id, poses] : robots) {
    const auto count = static_cast<double>(poses.seen.size());
    if (count < 0.7 * kNoisy) continue;
    ++mostly_aligned;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), scatter = mean;
    for (const Eigen::Vector3d& pose : poses.seen) mean += pose / count;
    for (const Eigen::Vector3d& pose : poses.seen) scatter += (pose - mean).cwiseAbs2() / count;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LT(scatter[axis], poses.variance[axis] / count) << "robot " << id << ", axis " << axis;
  }
  EXPECT_EQ(mostly_aligned, 6);
}

}  // namespace
}  // namespace nadir
