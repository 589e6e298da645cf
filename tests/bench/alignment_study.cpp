#include "tests/bench/alignment_study.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "calibration/fit/fit.h"
#include "tests/bench/cramer_rao.h"
#include "tests/bench/thread_cpu_clock.h"
#include "vision/synthetic/recording.h"

namespace nadir::bench {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr int kWarmUpFrames = 20;  // in which blur and noise are learnt
constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr double kMedianOfNormal = 0.6744897501960817;
constexpr double kGuess_rad = 0.02;

vision::Scene scene_of(const AlignmentCase& which) {
  const auto file = std::filesystem::path(NADIR_DATA_DIR) / "scenes" / (which.scene + ".yaml");
  vision::Scene scene = vision::load_scene(file);
  scene.sensor.exposure_s = which.exposure_s;
  scene.sensor.gamma = which.gamma;
  scene.light.level *= which.light;
  return scene;
}

/// From noise-free points, with the camera's own model: exact.
calibration::PlaneMap exact_map(const vision::Scene& scene) {
  const vision::CameraModel camera(scene.camera);
  vision::Scene exact = scene;
  exact.points.noise_px = 0.0;
  exact.points.survey_noise_m = 0.0;
  calibration::FieldPoints points;
  for (const vision::CalibrationPoint& point : vision::calibration_points(exact, camera, kSeed)) {
    points.points.push_back({point.pixel, point.world_m, 0});
  }
  return calibration::fit_map(
      calibration::ModelKind::kRadial, points,
      {.lens_centre_px = vision::PixelPoint(scene.camera.centre_u_px, scene.camera.centre_v_px)});
}

void compress(cv::Mat& bgr, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  bgr = cv::imdecode(bytes, cv::IMREAD_COLOR);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Sums {
  double square_px2 = 0.0, heading2 = 0.0, nees = 0.0, iterations = 0.0;
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero();
  std::uint64_t found = 0;
  double bound_px2 = 0.0, bound_heading2 = 0.0;
  std::uint64_t bounds = 0;
  std::vector<double> position_ratios, heading_ratios, times_us;
};

/// One case at work.
class Study {
 public:
  Study(const AlignmentCase& which, double guess_px, const tracker::AlignmentSettings& settings)
      : which_(which),
        scene_(scene_of(which)),
        renderer_(scene_, kSeed),
        map_(exact_map(scene_)),
        grid_(map_, scene_.camera.width_px, scene_.camera.height_px),
        aligner_(scene_.layouts.front(), grid_, settings),
        sensor_(scene_.camera.width_px, scene_.camera.height_px),
        bound_(scene_),
        guess_px_(guess_px) {}

  void frame(std::uint64_t number, bool counts);
  AlignmentStudy result() const;

 private:
  std::vector<vision::RobotPlacement> placements(std::uint64_t number);
  void judge(const vision::RobotPlacement& robot, const tracker::AlignedPose& aligned);
  void bound(const vision::RobotPlacement& robot, const tracker::AlignedPose& aligned,
             const vision::ShadowEdge* shadow);
  double m_per_px(const vision::RobotPlacement& robot) const {
    return grid_.metres_per_pixel(pixel(robot));
  }
  vision::PixelPoint pixel(const vision::RobotPlacement& robot) const {
    return renderer_.camera().project(
        {robot.motion.x_m, robot.motion.y_m, scene_.layouts.front().height_m});
  }

  AlignmentCase which_;
  vision::Scene scene_;
  vision::Renderer renderer_;
  calibration::PlaneMap map_;
  tracker::PlaneGrid grid_;
  tracker::PoseAligner aligner_;
  tracker::SensorModel sensor_;
  unsigned lessons_ = 0;
  CramerRaoBound bound_;
  double guess_px_;
  AlignmentStudy study_;
  Sums sums_;
};

std::vector<vision::RobotPlacement> Study::placements(std::uint64_t number) {
  std::vector<vision::RobotPlacement> robots = renderer_.placements(number);
  vision::RandomStream random(kSeed, number, 71);
  for (vision::RobotPlacement& robot : robots) {
    const double direction_rad = 2.0 * M_PI * random.uniform();
    robot.motion.velocity_x_mps = which_.speed_mps * std::cos(direction_rad);
    robot.motion.velocity_y_mps = which_.speed_mps * std::sin(direction_rad);
  }
  return robots;
}

void Study::frame(std::uint64_t number, bool counts) {
  const std::vector<vision::RobotPlacement> robots = placements(number);
  cv::Mat image;
  renderer_.render_robots(number, robots, image);
  if (which_.jpeg_quality > 0) compress(image, which_.jpeg_quality);
  std::optional<vision::ShadowEdge> shadow;
  if (scene_.light.shadow) {
    shadow.emplace(
        vision::shadow_in_frame(*scene_.light.shadow, image.cols, image.rows, kSeed, number), 0.0);
  }
  vision::RandomStream random(kSeed, number, 72);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    std::vector<tracker::Obstacle> others;
    for (std::size_t k = 0; k < robots.size(); ++k) {
      if (k == i) continue;
      others.push_back(
          {{robots[k].motion.x_m, robots[k].motion.y_m}, aligner_.robot().plate.radius_m});
    }
    const double guess_m = guess_px_ * m_per_px(robots[i]);
    const vision::RobotMotion& truth = robots[i].motion;
    const tracker::PoseGuess guess{
        {truth.x_m + guess_m * random.normal(), truth.y_m + guess_m * random.normal(),
         truth.heading_rad + kGuess_rad * random.normal()},
        pixel(robots[i])};
    tracker::AlignedPose aligned;
    const double start_us = thread_cpu_us();
    const bool found =
        aligner_.align(image, which_.mosaic, sensor_, guess, nullptr, others, aligned);
    const double time_us = thread_cpu_us() - start_us;
    if (found) aligner_.teach(image, which_.mosaic, lessons_++, sensor_);
    if (!counts) continue;
    ++study_.robots;
    if (!found) {
      ++study_.lost;
      continue;
    }
    sums_.times_us.push_back(time_us);
    judge(robots[i], aligned);
    if (number % robots.size() == i) bound(robots[i], aligned, shadow ? &*shadow : nullptr);
  }
}

void Study::judge(const vision::RobotPlacement& robot, const tracker::AlignedPose& aligned) {
  const Eigen::Vector3d error = fusion::pose_difference(
      aligned.pose_world_robot, {robot.motion.x_m, robot.motion.y_m, robot.motion.heading_rad});
  const Eigen::Vector2d error_px = aligned.centre_px - pixel(robot);
  const double nees = error.dot(aligned.covariance.ldlt().solve(error));
  sums_.square_px2 += 0.5 * error_px.squaredNorm();
  sums_.heading2 += error.z() * error.z();
  sums_.error_px += error_px;
  sums_.nees += nees;
  sums_.iterations += aligned.iterations;
  study_.worst_nees = std::max(study_.worst_nees, nees);
  if ((error.array().abs() > 6.0 * aligned.covariance.diagonal().array().sqrt()).any()) {
    ++study_.overconfident;
  }
  ++sums_.found;
}

void Study::bound(const vision::RobotPlacement& robot, const tracker::AlignedPose& aligned,
                  const vision::ShadowEdge* shadow) {
  const Eigen::Matrix3d covariance = bound_.covariance(robot, shadow);
  const double scale = m_per_px(robot);
  const double bound_px2 = 0.5 * (covariance(0, 0) + covariance(1, 1)) / (scale * scale);
  sums_.bound_px2 += bound_px2;
  sums_.bound_heading2 += covariance(2, 2);
  ++sums_.bounds;
  const Eigen::Vector2d error_px = aligned.centre_px - pixel(robot);
  for (int axis = 0; axis < 2; ++axis) {
    sums_.position_ratios.push_back(std::abs(error_px[axis]) / std::sqrt(bound_px2));
  }
  sums_.heading_ratios.push_back(std::abs(fusion::wrap_angle(aligned.pose_world_robot.heading_rad -
                                                             robot.motion.heading_rad)) /
                                 std::sqrt(covariance(2, 2)));
}

AlignmentStudy Study::result() const {
  AlignmentStudy study = study_;
  const auto found = static_cast<double>(sums_.found);
  const auto bounds = static_cast<double>(sums_.bounds);
  study.position_rms_px = std::sqrt(sums_.square_px2 / found);
  study.heading_rms_deg = kDegreesPerRadian * std::sqrt(sums_.heading2 / found);
  study.bias_px = sums_.error_px / found;
  study.nees = sums_.nees / found;
  study.iterations = sums_.iterations / found;
  study.position_bound_px = std::sqrt(sums_.bound_px2 / bounds);
  study.heading_bound_deg = kDegreesPerRadian * std::sqrt(sums_.bound_heading2 / bounds);
  study.position_median_ratio = median(sums_.position_ratios) / kMedianOfNormal;
  study.heading_median_ratio = median(sums_.heading_ratios) / kMedianOfNormal;
  study.microseconds = median(sums_.times_us);
  study.blur_px = sensor_.blur_px();
  study.read = sensor_.noise().read;
  study.shot = sensor_.noise().shot;
  return study;
}

}  // namespace

std::vector<AlignmentCase> alignment_cases() {
  using tracker::Mosaic;
  std::vector<AlignmentCase> cases;
  for (const std::string kind : {"pair", "league"}) {
    cases.push_back({kind + " even", kind + "_even"});
    cases.push_back({kind + " Bayer", kind + "_bayer", Mosaic::kRggb});
    cases.push_back({kind + " dim", kind + "_dim_warm"});
    cases.push_back({kind + " shadow", kind + "_shadow"});
    cases.push_back(
        {.name = kind + " moving", .scene = kind + "_even", .speed_mps = 1.0, .exposure_s = 0.005});
    cases.push_back({.name = kind + " gamma", .scene = kind + "_even", .gamma = 1.0 / 0.7});
    cases.push_back({.name = kind + " JPEG", .scene = kind + "_even", .jpeg_quality = 80});
    cases.push_back({.name = kind + " bright", .scene = kind + "_even", .light = 1.3});
  }
  cases.push_back({"pair far", "pair_far"});
  return cases;
}

AlignmentStudy study_alignment(const AlignmentCase& which, int frames, double guess_px,
                               const tracker::AlignmentSettings& settings) {
  Study study(which, guess_px, settings);
  for (int i = 0; i < kWarmUpFrames; ++i) study.frame(static_cast<std::uint64_t>(i), false);
  for (int i = 0; i < frames; ++i) study.frame(static_cast<std::uint64_t>(kWarmUpFrames + i), true);
  return study.result();
}

}  // namespace nadir::bench
