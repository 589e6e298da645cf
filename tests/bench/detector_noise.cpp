#include "tests/bench/detector_noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "calibration/noise_file.h"
#include "fusion/planar_pose.h"
#include "tests/support/accuracy_study.h"
#include "tracker/camera_pipeline.h"
#include "vision/synthetic/renderer.h"

namespace nadir::bench {
namespace {

constexpr std::uint64_t kSeed = 23;
constexpr double kMatchRadii = 0.5;  // half a mark's radius

/// The scene under a camera that shows a mark with so many pixels, straight down and undistorted:
/// then a polynomial is exact.
vision::Scene seen_from(vision::Scene scene, double expected_pixels) {
  const vision::MarkerLayout& layout = scene.layouts.front();
  const double radius_px = std::sqrt(expected_pixels / std::numbers::pi);
  scene.camera.tilt_rad = 0.0;
  scene.camera.k1 = 0.0;
  scene.camera.k2 = 0.0;
  scene.camera.focal_px =
      radius_px / layout.centre_radius_m * (scene.camera.height_m - layout.height_m);
  return scene;
}

/// A pipeline for each law.
std::deque<tracker::CameraPipeline> pipelines(const vision::Scene& scene,
                                              const std::filesystem::path& table_file) {
  tracker::PipelineSetup setup{.camera = "cam0",
                               .calibration = support::calibrate_from_scene(scene, kSeed),
                               .calibration_file = "scene",
                               .layouts = scene.layouts};
  using Source = tracker::PoseSource;
  std::deque<tracker::CameraPipeline> made;  // they cannot be moved
  const auto make = [&](Source source, const calibration::PixelCountVariance& variance) {
    setup.source = source;
    setup.variance = variance;
    made.emplace_back(setup, scene.camera.width_px, scene.camera.height_px);
  };
  make(Source::kAlignment, {});
  make(Source::kAlignedAndCounts, calibration::PixelCountVariance(calibration::LawVariance{}));
  make(Source::kAlignedAndCounts, calibration::load_pixel_count_variance(table_file));
  make(Source::kDetector, {});
  return made;
}

const tracker::RobotReport* nearest(const tracker::FrameReport& report,
                                    const vision::RobotTruth& truth, double within_px) {
  const tracker::RobotReport* found = nullptr;
  for (const tracker::RobotReport& robot : report.robots) {
    const double distance_px =
        (robot.centre_px - vision::PixelPoint(truth.u_px, truth.v_px)).norm();
    if (distance_px > within_px) continue;
    within_px = distance_px;
    found = &robot;
  }
  return found;
}

PoseVariance published(const fusion::PoseCovariance& covariance) {
  return {0.5 * (covariance(0, 0) + covariance(1, 1)), covariance(2, 2)};
}

void add(PoseVariance& sum, const PoseVariance& more) {
  sum.place_m2 += more.place_m2;
  sum.heading_rad2 += more.heading_rad2;
}

void divide(PoseVariance& sum, double count) {
  sum.place_m2 /= count;
  sum.heading_rad2 /= count;
}

Eigen::Vector3d error_of(const tracker::RobotReport& robot, const vision::RobotTruth& truth) {
  return fusion::pose_difference(robot.pose_world_robot, {truth.x_m, truth.y_m, truth.heading_rad});
}

/// Sums over robots; made means by finish().
void add_robot(const tracker::RobotReport& robot, const vision::RobotTruth& truth,
               CountNoise& noise) {
  const Eigen::Vector3d error = error_of(robot, truth);
  ++noise.aligned;
  noise.pixels += robot.pixels[0];
  noise.x_m2 += error.x() * error.x();
  noise.y_m2 += error.y() * error.y();
  noise.measured.heading_rad2 += error.z() * error.z();
}

void add_published(const tracker::RobotReport& robot, const vision::RobotTruth& truth,
                   std::size_t law, CountNoise& noise) {
  const Eigen::Vector3d error = error_of(robot, truth);
  add(noise.published[law], published(robot.covariance));
  noise.nees[law] += error.dot(robot.covariance.ldlt().solve(error));
  ++noise.published_robots[law];
  if (law != kDetectorLaw) return;
  add(noise.measured_detector, {0.5 * error.head<2>().squaredNorm(), error.z() * error.z()});
}

void finish(CountNoise& noise) {
  const double count = noise.aligned;
  noise.pixels /= count;
  noise.x_m2 /= count;
  noise.y_m2 /= count;
  noise.measured.heading_rad2 /= count;
  noise.measured.place_m2 = 0.5 * (noise.x_m2 + noise.y_m2);
  for (std::size_t law = 0; law < noise.published.size(); ++law) {
    divide(noise.published[law], noise.published_robots[law]);
    noise.nees[law] /= noise.published_robots[law];
  }
  divide(noise.measured_detector, noise.published_robots[kDetectorLaw]);
}

CountNoise study_one(const vision::Scene& scene, double expected_pixels, int frames,
                     const std::filesystem::path& table_file) {
  vision::Renderer renderer(scene, kSeed);
  std::deque<tracker::CameraPipeline> laws = pipelines(scene, table_file);
  const double radius_px = std::sqrt(expected_pixels / std::numbers::pi);
  CountNoise noise;
  noise.expected_pixels = expected_pixels;
  noise.pixels_per_metre = radius_px / scene.layouts.front().centre_radius_m;
  std::array<tracker::FrameReport, kVarianceLaws.size()> reports;
  vision::Frame frame;
  for (int i = 0; i < frames; ++i) {
    frame.number = static_cast<std::uint64_t>(i);
    frame.capture_time = renderer.capture_time(frame.number);
    renderer.render(frame.number, frame.image);
    for (std::size_t law = 0; law < laws.size(); ++law) {
      laws[law].process(frame, 0.0, reports[law]);
    }
    const int found_before = noise.found;
    for (const vision::RobotTruth& truth : renderer.truth(frame.number)) {
      ++noise.robots;
      const auto* robot = nearest(reports[0], truth, kMatchRadii * radius_px);
      if (robot == nullptr) continue;
      ++noise.found;
      if (!robot->aligned) continue;
      add_robot(*robot, truth, noise);
      for (std::size_t law = 0; law < laws.size(); ++law) {
        const auto* same = nearest(reports[law], truth, kMatchRadii * radius_px);
        if (same != nullptr) add_published(*same, truth, law, noise);
      }
    }
    noise.false_robots += static_cast<int>(reports[0].robots.size()) - (noise.found - found_before);
  }
  finish(noise);
  return noise;
}

}  // namespace

double NoiseStudy::found_share(double least_pixels, double most_pixels) const {
  double robots = 0.0;
  double found = 0.0;
  for (const CountNoise& count : counts) {
    if (count.expected_pixels < least_pixels || count.expected_pixels > most_pixels) continue;
    robots += count.robots;
    found += count.found;
  }
  return robots > 0.0 ? found / robots : 0.0;
}

NoiseStudy study_detector_noise(const std::string& sensor, const vision::Scene& scene,
                                const std::vector<double>& expected_pixels, int frames,
                                const std::filesystem::path& table_file) {
  NoiseStudy study{sensor, {}};
  for (const double pixels : expected_pixels) {
    study.counts.push_back(study_one(seen_from(scene, pixels), pixels, frames, table_file));
  }
  return study;
}

std::vector<double> in_equal_ratios(double first, double last, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    values.push_back(first * std::pow(last / first, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

}  // namespace nadir::bench
