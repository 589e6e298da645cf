#include "tests/support/accuracy_study.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>

#include "calibration/field_points.h"
#include "calibration/fit/fit.h"
#include "fusion/planar_pose.h"
#include "tracker/camera_pipeline.h"
#include "vision/synthetic/recording.h"

namespace nadir::support {
namespace {

constexpr double kMatchDistance_px = 5.0;
constexpr double kDegreesPerRadian = 57.29577951308232;

void compare(const tracker::FrameReport& report, const std::vector<vision::RobotTruth>& truth,
             bool anonymous, AccuracyStudy& study) {
  std::vector<bool> seen(truth.size(), false);
  study.robots += truth.size();
  for (const tracker::RobotReport& robot : report.robots) {
    std::size_t nearest = truth.size();
    double nearest_px = kMatchDistance_px;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double distance_px =
          std::hypot(truth[i].u_px - robot.centre_px.x(), truth[i].v_px - robot.centre_px.y());
      if (distance_px < nearest_px) {
        nearest = i;
        nearest_px = distance_px;
      }
    }
    if (nearest == truth.size() || seen[nearest]) {
      ++study.false_robots;
      continue;
    }
    seen[nearest] = true;
    const vision::RobotTruth& t = truth[nearest];
    if (!anonymous && (robot.id != t.id || robot.team != t.team)) {
      ++study.wrong_names;
      continue;
    }
    PoseError error;
    error.centre_px = robot.centre_px - vision::PixelPoint(t.u_px, t.v_px);
    error.pose = fusion::pose_difference(robot.pose_world_robot, {t.x_m, t.y_m, t.heading_rad});
    error.covariance = robot.covariance;
    error.pixels.assign(robot.pixels.begin(), robot.pixels.begin() + robot.marker_count);
    study.errors.push_back(std::move(error));
  }
  for (const bool was_seen : seen) study.missed += was_seen ? 0 : 1;
}

}  // namespace

double PoseError::nees() const { return pose.dot(covariance.ldlt().solve(pose)); }

double AccuracyStudy::found_share() const {
  return robots == 0 ? 0.0 : static_cast<double>(errors.size()) / static_cast<double>(robots);
}

Eigen::Vector2d AccuracyStudy::centre_rms_px() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const PoseError& e : errors) sum += e.centre_px.cwiseAbs2();
  return (sum / static_cast<double>(errors.size())).cwiseSqrt();
}

Eigen::Vector2d AccuracyStudy::centre_bias_px() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const PoseError& e : errors) sum += e.centre_px;
  return sum / static_cast<double>(errors.size());
}

double AccuracyStudy::heading_rms_deg() const {
  double sum = 0.0;
  for (const PoseError& e : errors) sum += e.pose.z() * e.pose.z();
  return kDegreesPerRadian * std::sqrt(sum / static_cast<double>(errors.size()));
}

double AccuracyStudy::mean_nees() const {
  double sum = 0.0;
  for (const PoseError& e : errors) sum += e.nees();
  return sum / static_cast<double>(errors.size());
}

calibration::Calibration calibrate_from_scene(const vision::Scene& scene, std::uint64_t seed) {
  const vision::CameraModel camera(scene.camera);
  calibration::FieldPoints points;
  for (const vision::CalibrationPoint& point : vision::calibration_points(scene, camera, seed)) {
    points.points.push_back({point.pixel, point.world_m, 0});
  }
  calibration::StatedNoise noise;
  if (scene.points.noise_px > 0.0) noise.pixel_px = scene.points.noise_px;
  if (scene.points.survey_noise_m > 0.0) noise.survey_m = scene.points.survey_noise_m;
  const calibration::FieldFit fit = calibration::fit_polynomial2(points, noise);
  calibration::Calibration calibration{fit.map};
  calibration.height_m = scene.points.height_m;
  calibration.image_width_px = scene.camera.width_px;
  calibration.image_height_px = scene.camera.height_px;
  calibration.points_box = calibration::pixel_box(points);
  calibration.residuals = fit.residuals;
  calibration.noise = noise;
  return calibration;
}

AccuracyStudy study_accuracy(const vision::Scene& scene, std::uint64_t seed, int frames,
                             const calibration::PixelCountVariance& variance) {
  vision::Renderer renderer(scene, seed);
  tracker::PipelineSetup setup{.camera = "cam0",
                               .calibration = calibrate_from_scene(scene, seed),
                               .calibration_file = "scene",
                               .layouts = scene.layouts,
                               .variance = variance,
                               .tracks = {}};
  tracker::CameraPipeline pipeline(std::move(setup), scene.camera.width_px, scene.camera.height_px);
  AccuracyStudy study;
  vision::Frame frame;
  tracker::FrameReport report;
  for (int i = 0; i < frames; ++i) {
    frame.number = static_cast<std::uint64_t>(i);
    frame.capture_time = renderer.capture_time(frame.number);
    renderer.render(frame.number, frame.image);
    pipeline.process(frame, 0.0, report);
    compare(report, renderer.truth(frame.number), scene.layouts.front().is_anonymous(), study);
  }
  return study;
}

}  // namespace nadir::support
