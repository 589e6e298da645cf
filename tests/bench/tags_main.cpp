// tags: robots with AprilTags beside libapriltag alone and the Cramer-Rao bound.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "calibration/fit/fit.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/json_file.h"
#include "tests/bench/tag_bound.h"
#include "tests/bench/thread_cpu_clock.h"
#include "tracker/tag_robots.h"
#include "vision/synthetic/recording.h"

namespace {

using namespace nadir;
using nadir::bench::thread_cpu_us;

constexpr double kPxPerM = 420.0;
constexpr double kSixSigma = 42.8;  // of three degrees of freedom, as likely as six of one
constexpr double kDegrees = 180.0 / std::numbers::pi;

// An exact calibration: a perfect lens that looks straight down.
vision::Scene flat_scene(const std::string& name) {
  vision::Scene scene =
      vision::load_scene(std::string(NADIR_DATA_DIR) + "/scenes/" + name + ".yaml");
  scene.camera.tilt_rad = scene.camera.k1 = 0.0;
  return scene;
}

calibration::PlaneMap exact_map(const vision::Renderer& renderer) {
  calibration::FieldPoints points;
  for (const auto& point : vision::calibration_points(renderer.scene(), renderer.camera(), 1)) {
    points.points.push_back({point.pixel, point.world_m, 0});
  }
  return calibration::fit_polynomial2(points, {}).map;
}

// Layouts of one height share the map.
std::vector<tracker::TagRobotKind> kinds_of(const vision::Renderer& renderer) {
  const calibration::PlaneMap map = exact_map(renderer);
  std::vector<tracker::TagRobotKind> kinds;
  for (std::size_t i = 0; i < renderer.scene().layouts.size(); ++i) {
    kinds.push_back({*renderer.scene().layouts[i].tags, map, i});
  }
  return kinds;
}

tracker::TagRobots tracker_of(const vision::Renderer& renderer, bool aligned) {
  return {kinds_of(renderer), renderer.camera().width_px(), renderer.camera().height_px(),
          tracker::TagSettings{.aligned = aligned}};
}

struct Errors {
  std::uint64_t shown = 0, found = 0, wrong = 0, overconfident = 0;
  double place = 0.0, heading = 0.0, nees = 0.0;

  void add(const tracker::TagRobots& robots, const std::vector<vision::RobotTruth>& truth,
           double px_per_m) {
    shown += truth.size();
    for (const tracker::TagRobot& robot : robots.robots()) {
      const auto at = std::ranges::find_if(truth, [&](const vision::RobotTruth& one) {
        return one.id == robot.id && one.layout == robot.layout_index;
      });
      const fusion::PlanarPose& pose = robot.pose.pose_world_robot;
      if (at == truth.end() || std::hypot(pose.x_m - at->x_m, pose.y_m - at->y_m) > 0.02) {
        ++wrong;
        continue;
      }
      const Eigen::Vector3d error(pose.x_m - at->x_m, pose.y_m - at->y_m,
                                  fusion::wrap_angle(pose.heading_rad - at->heading_rad));
      ++found;
      place += 0.5 * error.head<2>().squaredNorm() * px_per_m * px_per_m;
      heading += error.z() * error.z();
      const double now = error.dot(robot.pose.covariance.inverse() * error);
      nees += now;
      overconfident += now > kSixSigma ? 1 : 0;
    }
  }
  double place_px() const { return std::sqrt(place / static_cast<double>(found)); }
  double heading_deg() const { return kDegrees * std::sqrt(heading / static_cast<double>(found)); }
};

// One row of the table of accuracies.
struct AccuracyCase {
  std::string name;
  vision::Scene scene;
  double speed_mps = 0.0;  // in all directions, over the exposure
  int jpeg_quality = 0;    // 0: not compressed
};

std::vector<AccuracyCase> accuracy_cases() {
  const vision::Scene even = flat_scene("tags_even");
  std::vector<AccuracyCase> cases = {
      {"even", even},        {"bayer", even}, {"dim", flat_scene("tags_dim")}, {"shadow", even},
      {"moving", even, 1.0}, {"gamma", even}, {"JPEG", even, 0.0, 80}};
  cases[1].scene.sensor.mosaic = vision::SceneSensor::Mosaic::kRggb;
  cases[3].scene.light.shadow = vision::SceneShadow{.random = true};
  cases[4].scene.sensor.exposure_s = 0.005;
  cases[5].scene.sensor.gamma = 1.0 / 0.7;
  return cases;
}

// New places in every frame: robots are detected, then aligned.
vision::Frame frame_of(const AccuracyCase& which, vision::Renderer& renderer, std::uint64_t number,
                       std::vector<vision::RobotPlacement>& robots) {
  robots = renderer.placements(number);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].motion.velocity_x_mps = which.speed_mps * std::cos(static_cast<double>(i));
    robots[i].motion.velocity_y_mps = which.speed_mps * std::sin(static_cast<double>(i));
  }
  vision::Frame frame;
  renderer.render_robots(number, robots, frame.image);
  if (which.jpeg_quality > 0) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", frame.image, bytes, {cv::IMWRITE_JPEG_QUALITY, which.jpeg_quality});
    frame.image = cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  frame.capture_time = renderer.capture_time(number) + std::chrono::seconds(number);
  return frame;
}

// Mean squares of position, px, and heading, rad.
struct Bounds {
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  int count = 0;

  void add(const vision::Scene& scene, const vision::RobotPlacement& robot) {
    const Eigen::Matrix3d covariance = bench::tag_bound(scene, robot);
    squares += Eigen::Vector2d(0.5 * covariance.topLeftCorner<2, 2>().trace() * kPxPerM * kPxPerM,
                               covariance(2, 2));
    ++count;
  }
  double place_px() const { return std::sqrt(squares[0] / count); }
  double heading_deg() const { return kDegrees * std::sqrt(squares[1] / count); }
};

nlohmann::json report_accuracy(const std::string& name, const Errors& aligned,
                               const Errors& corners, const Bounds& bounds) {
  const auto found = static_cast<double>(aligned.found);
  fmt::print(
      "{:<6} {:>5}/{:<5} wrong {}  corners {:.4f} px {:.4f} deg NEES {:.2f}  aligned {:.5f} px "
      "{:.5f} deg  times better {:.1f} {:.1f}  over bound {:.2f} {:.2f}  NEES {:.2f}, beyond six "
      "sigma {} (corners {})\n",
      name, aligned.found, aligned.shown, aligned.wrong + corners.wrong, corners.place_px(),
      corners.heading_deg(), corners.nees / static_cast<double>(corners.found), aligned.place_px(),
      aligned.heading_deg(), corners.place_px() / aligned.place_px(),
      corners.heading_deg() / aligned.heading_deg(), aligned.place_px() / bounds.place_px(),
      aligned.heading_deg() / bounds.heading_deg(), aligned.nees / found, aligned.overconfident,
      corners.overconfident);
  std::fflush(stdout);
  return {{"case", name},
          {"shown", aligned.shown},
          {"found", aligned.found},
          {"wrong", aligned.wrong},
          {"corners_px", corners.place_px()},
          {"corners_deg", corners.heading_deg()},
          {"corners_nees", corners.nees / static_cast<double>(corners.found)},
          {"aligned_px", aligned.place_px()},
          {"aligned_deg", aligned.heading_deg()},
          {"bound_px", bounds.place_px()},
          {"bound_deg", bounds.heading_deg()},
          {"nees", aligned.nees / found},
          {"beyond_six_sigma", aligned.overconfident},
          {"corners_beyond_six_sigma", corners.overconfident}};
}

// The bound is that of the frame before it was spoilt.
nlohmann::json measure_accuracy(const AccuracyCase& which, int frames) {
  constexpr int kLearning = 5;
  vision::Renderer renderer(which.scene, 11);
  tracker::TagRobots aligned = tracker_of(renderer, true);
  tracker::TagRobots detected = tracker_of(renderer, false);
  Errors by_pixels, by_corners;
  Bounds bounds;
  std::vector<vision::RobotPlacement> placements;
  std::vector<tracker::RejectionReport> rejected;
  for (int k = 0; k < frames + kLearning; ++k) {
    const vision::Frame frame =
        frame_of(which, renderer, static_cast<std::uint64_t>(k), placements);
    const std::vector<vision::RobotTruth> truth = renderer.truth_of(placements);
    for (tracker::TagRobots* robots : {&aligned, &detected}) {
      rejected.clear();
      robots->detect(frame);
      robots->locate(rejected);
      if (k >= kLearning)
        (robots == &aligned ? by_pixels : by_corners).add(*robots, truth, kPxPerM);
    }
    if (k % 5 == 0) bounds.add(renderer.scene(), placements.front());
  }
  return report_accuracy(which.name, by_pixels, by_corners, bounds);
}

// Twelve tags of 30, 42 and 60 px.
vision::Scene three_sizes() {
  vision::Scene scene = flat_scene("tags_even");
  const vision::MarkerLayout usual = scene.layouts.front();
  scene.layouts.clear();
  scene.bodies.clear();
  scene.random_robots.clear();
  int next_id = 0;
  for (const double size_px : {30.0, 42.0, 60.0}) {
    vision::MarkerLayout layout = usual;
    layout.name = layout.teams[0].name = fmt::format("tags{}", size_px);
    layout.tags->size_m = size_px / 420.0;
    for (int i = 0; i < 40; ++i, ++next_id) {
      layout.tags->tags.push_back({next_id, next_id, {}});
    }
    scene.random_robots.push_back(
        {.layout = scene.layouts.size(), .teams = {0}, .count = 4, .minimum_distance_m = 0.28});
    scene.layouts.push_back(layout);
    scene.bodies.push_back(vision::default_body(layout));
  }
  return scene;
}

nlohmann::json count_found(int frames) {
  vision::Renderer renderer(three_sizes(), 21);
  tracker::TagRobots robots = tracker_of(renderer, true);
  Errors errors;
  std::vector<tracker::RejectionReport> rejected;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    vision::Frame frame;
    renderer.render(number, frame.image);
    frame.capture_time = renderer.capture_time(number) + std::chrono::seconds(k);
    robots.detect(frame);
    robots.locate(rejected);
    errors.add(robots, renderer.truth(number), 420.0);
  }
  fmt::print("tags of 30, 42 and 60 px, {} frames: {} of {} found, {} false\n", frames,
             errors.found, errors.shown, errors.wrong);
  return {{"frames", frames},
          {"shown", errors.shown},
          {"found", errors.found},
          {"wrong", errors.wrong}};
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

nlohmann::json measure_speed(int frames) {
  vision::Renderer renderer(flat_scene("tags_even"), 31);
  tracker::TagRobots followed = tracker_of(renderer, true);
  vision::TagDetector plain("tag36h11", 2.0);
  vision::TagDetector tuned("tag36h11", 2.0);
  tuned.set_least_contrast(40);
  std::vector<vision::RobotPlacement> placements = renderer.placements(0);
  std::vector<double> follow_us, regions_us, tuned_us, plain_us, cold_us;
  std::vector<tracker::RejectionReport> rejected;
  std::vector<vision::TagObservation> seen;
  const auto timed = [](std::vector<double>& times, const auto& work) {
    const double start = thread_cpu_us();
    work();
    times.push_back(thread_cpu_us() - start);
  };
  std::size_t aligned = 0;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    for (vision::RobotPlacement& robot : placements) robot.motion.heading_rad += 0.03;
    vision::Frame frame;
    frame.capture_time = renderer.capture_time(number);
    renderer.render_robots(number, placements, frame.image);
    const auto work = [&](tracker::TagRobots& robots) {
      robots.detect(frame);
      robots.locate(rejected);
    };
    timed(follow_us, [&] { work(followed); });
    aligned += followed.followed();
    timed(plain_us, [&] { plain.detect(frame.image); });
    timed(tuned_us, [&] { tuned.detect(frame.image); });
    timed(regions_us, [&] {
      for (const vision::RobotTruth& robot : renderer.truth_of(placements)) {
        seen.clear();
        tuned.detect_in(frame.image, vision::tag_box({robot.u_px, robot.v_px}, 42.0, 4.0), seen);
      }
    });
    tracker::TagRobots fresh = tracker_of(renderer, true);
    timed(cold_us, [&] { work(fresh); });
  }
  const double us = median(follow_us);
  fmt::print(
      "12 tags of 42 px, CPU us: followed {:.0f} ({:.1f} tags a frame aligned), cold {:.0f}; "
      "libapriltag, decimation 2: regions {:.0f}, frame tuned {:.0f}, frame as it comes {:.0f}\n"
      "followed is {:.1f} times as fast as regions, {:.1f} times as fast as the frame; cold takes "
      "{:.2f} of the tuned frame\n",
      us, static_cast<double>(aligned) / frames, median(cold_us), median(regions_us),
      median(tuned_us), median(plain_us), median(regions_us) / us, median(plain_us) / us,
      median(cold_us) / median(tuned_us));
  return {{"followed_us", us},
          {"cold_us", median(cold_us)},
          {"regions_us", median(regions_us)},
          {"frame_tuned_us", median(tuned_us)},
          {"frame_us", median(plain_us)}};
}

}  // namespace

int main(int argc, char** argv) {
  std::string json_file;
  int frames = 40;
  int search_frames = 100;
  CLI::App app("Robots with AprilTags beside libapriltag and the Cramer-Rao bound.", "tags");
  app.footer("Example: tags --search-frames 500 --json tags.json");
  app.add_option("--json", json_file, "write the figures to this file too");
  app.add_option("--frames", frames, "of each case")->check(CLI::Range(1, 1000000));
  app.add_option("--search-frames", search_frames, "in which tags are counted")
      ->check(CLI::Range(1, 1000000));
  return nadir::bench::bench_main(argc, argv, app, [&] {
    nlohmann::json cases = nlohmann::json::array();
    for (const AccuracyCase& which : accuracy_cases()) {
      cases.push_back(measure_accuracy(which, frames));
    }
    nadir::bench::write_json_file({{"benchmark", "tags"},
                                   {"accuracy", cases},
                                   {"search", count_found(search_frames)},
                                   {"speed", measure_speed(frames)}},
                                  json_file);
  });
}
