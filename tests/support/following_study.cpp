#include "tests/support/following_study.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "tests/support/accuracy_study.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::support {
namespace {

constexpr int kRobots = 12;
constexpr double kTouching_m = 0.181;  // between the centres of two robots of 90 mm radius
constexpr double kFirstLane_m = -1.9;
constexpr double kLane_m = 0.76;
constexpr double kHalfWay_m = 2.2;
constexpr double kCoverTime_s = 0.4;
constexpr double kLiftTime_s = 0.7;
constexpr double kMatch_px = 12.0;

vision::Scene empty(vision::Scene scene) {
  scene.random_robots.clear();
  scene.clutter.random_count = 0;
  return scene;
}

/// One study at work.
class Story {
 public:
  Story(vision::Scene scene, const FollowingStory& story, std::uint64_t seed)
      : story_(story),
        seed_(seed),
        scene_(empty(std::move(scene))),
        renderer_(scene_, seed),
        pipeline_(setup(), scene_.camera.width_px, scene_.camera.height_px) {}

  FollowingStudy run();

 private:
  struct Cover {
    std::vector<int> discs;  // of the robot; empty: none
  };

  tracker::PipelineSetup setup() const {
    return {.camera = "cam0",
            .calibration = calibrate_from_scene(scene_, seed_),
            .calibration_file = "scene",
            .layouts = scene_.layouts,
            .source = story_.source};
  }
  std::vector<vision::RobotPlacement> robots_at(int frame) const;
  vision::RobotMotion pair_motion(int slot, double time_s) const;
  vision::RobotMotion crossing_motion(int slot, double time_s) const;
  int who_is_at(int slot, double time_s) const;
  Cover cover_of(int robot, int frame) const;
  bool is_there(int robot, int frame) const;
  void paint(int frame, const std::vector<vision::RobotPlacement>& robots, cv::Mat& image) const;
  void paint_disc(const vision::RobotPlacement& robot, int disc, std::uint64_t colour,
                  cv::Mat& image) const;
  void judge(int frame, const std::vector<vision::RobotPlacement>& robots,
             const tracker::FrameReport& report);
  void count(int robot, int frame, bool seen);
  vision::PixelPoint pixel(const Eigen::Vector2d& place_m) const {
    return renderer_.camera().project({place_m.x(), place_m.y(), scene_.layouts[0].height_m});
  }

  FollowingStory story_;
  std::uint64_t seed_;
  vision::Scene scene_;
  vision::Renderer renderer_;
  tracker::CameraPipeline pipeline_;
  FollowingStudy study_;
  std::vector<int> unseen_ = std::vector<int>(kRobots, 0);  // frames in sight since last seen
  std::vector<bool> is_new_ = std::vector<bool>(kRobots, true);
  double squares_px2_ = 0.0;
  std::uint64_t matched_ = 0;
};

// Pair k drives to and fro on a lane of its own and turns.
vision::RobotMotion Story::pair_motion(int slot, double time_s) const {
  const int pair = slot / 2;
  const double lane_m = kFirstLane_m + kLane_m * pair;
  const double way_m = story_.speed_mps * time_s + 0.9 * pair;
  const double x_m = kHalfWay_m * std::sin(way_m / kHalfWay_m);
  const double turn_rad = (pair % 2 == 0 ? 1.0 : -1.0) * (2.0 * time_s + pair);
  const double side = slot % 2 == 0 ? 0.5 : -0.5;
  vision::RobotMotion motion;
  motion.x_m = x_m + side * kTouching_m * std::cos(turn_rad);
  motion.y_m = lane_m + side * kTouching_m * std::sin(turn_rad);
  motion.heading_rad = fusion::wrap_angle(1.5 * turn_rad + slot);
  return motion;
}

// Half of them drive along x and half along y; where ways cross one has just gone when the other
// comes: they pass 0.19 m from each other.
vision::RobotMotion Story::crossing_motion(int slot, double time_s) const {
  constexpr double kAhead_m = 0.27;
  const double lane_m = kFirstLane_m + kLane_m * (slot / 2);
  const double way_m = kHalfWay_m * std::sin(story_.speed_mps * time_s / kHalfWay_m);
  vision::RobotMotion motion;
  motion.x_m = slot % 2 == 0 ? way_m + kAhead_m : lane_m;
  motion.y_m = slot % 2 == 0 ? lane_m : way_m;
  motion.heading_rad = fusion::wrap_angle(2.0 * time_s + slot);
  return motion;
}

// Every second two robots have been carried to each other's places.
int Story::who_is_at(int slot, double time_s) const {
  const int swaps = story_.swaps ? static_cast<int>(time_s) : 0;
  int who = slot;
  for (int swap = 0; swap < swaps; ++swap) {
    const int a = (5 * swap) % kRobots;
    const int b = (5 * swap + 7) % kRobots;
    who = who == a ? b : who == b ? a : who;
  }
  return who;
}

std::vector<vision::RobotPlacement> Story::robots_at(int frame) const {
  const double time_s = frame / scene_.rate_hz;
  std::vector<vision::RobotPlacement> robots(kRobots);
  for (int slot = 0; slot < kRobots; ++slot) {
    vision::RobotPlacement& robot = robots[static_cast<std::size_t>(slot)];
    robot.id = who_is_at(slot, time_s);
    robot.team = static_cast<std::size_t>(robot.id % 2);
    robot.motion = story_.crossing ? crossing_motion(slot, time_s) : pair_motion(slot, time_s);
  }
  return robots;
}

// The robot of a slot is away for some of its times; the slot has moved on when it comes back.
bool Story::is_there(int robot, int frame) const {
  if (!story_.lifts) return true;
  const int period = static_cast<int>(kLiftTime_s * scene_.rate_hz);
  vision::RandomStream random(seed_, static_cast<std::uint64_t>((frame + 5 * robot) / period),
                              200 + static_cast<std::uint64_t>(robot));
  return random.uniform() > 0.3;
}

Story::Cover Story::cover_of(int robot, int frame) const {
  if (!story_.covers_one_disc && !story_.covers_two_discs) return {};
  const int period = static_cast<int>(kCoverTime_s * scene_.rate_hz);
  vision::RandomStream random(seed_, static_cast<std::uint64_t>(frame / period),
                              100 + static_cast<std::uint64_t>(robot));
  if (frame < period || random.uniform() > 0.3) return {};
  const int first = static_cast<int>(random.below(5));
  const int second = (first + 1 + static_cast<int>(random.below(4))) % 5;
  const bool two = story_.covers_two_discs && (!story_.covers_one_disc || random.uniform() < 0.5);
  return two ? Cover{{first, second}} : Cover{{first}};
}

void Story::paint_disc(const vision::RobotPlacement& robot, int disc, std::uint64_t colour,
                       cv::Mat& image) const {
  const vision::Disc mark = scene_.layouts[0].disc(disc, 0, 0);
  const double c = std::cos(robot.motion.heading_rad);
  const double s = std::sin(robot.motion.heading_rad);
  const Eigen::Vector2d& p = mark.position_robot_m;
  const vision::PixelPoint at =
      pixel({robot.motion.x_m + c * p.x() - s * p.y(), robot.motion.y_m + s * p.x() + c * p.y()});
  const cv::Scalar colours[] = {{25, 125, 235}, {40, 40, 40}, {60, 200, 110}, {160, 60, 235}};
  constexpr int kShift = 4;
  cv::circle(
      image,
      {static_cast<int>(std::lround(16 * at.x())), static_cast<int>(std::lround(16 * at.y()))},
      static_cast<int>(std::lround(16 * 1.25 * mark.radius_m * 212.8)), colours[colour % 4],
      cv::FILLED, cv::LINE_AA, kShift);
}

void Story::paint(int frame, const std::vector<vision::RobotPlacement>& robots,
                  cv::Mat& image) const {
  for (int i = 0; i < kRobots; ++i) {
    const auto& robot = robots[static_cast<std::size_t>(i)];
    if (!is_there(i, frame)) continue;
    for (const int disc : cover_of(i, frame).discs) {
      // Things have another colour than what they cover: orange, black.
      paint_disc(robot, disc, static_cast<std::uint64_t>(disc + i) % 2, image);
    }
  }
  if (!story_.balls) return;
  vision::RandomStream random(seed_, static_cast<std::uint64_t>(frame), 9);
  for (int i = 0; i < 20; ++i) {
    const double u = random.uniform(20.0, image.cols - 20.0);
    const double v = random.uniform(20.0, image.rows - 20.0);
    // A ball may touch a robot's side, but lies on the floor.
    const bool free = std::ranges::all_of(robots, [&](const vision::RobotPlacement& robot) {
      return (pixel({robot.motion.x_m, robot.motion.y_m}) - vision::PixelPoint(u, v)).norm() >
             (0.09 + 0.0215) * 212.8;
    });
    if (!free) continue;
    const cv::Scalar colours[] = {{25, 125, 235}, {230, 140, 20}, {60, 200, 110}, {160, 60, 235}};
    cv::circle(image, {static_cast<int>(16 * u), static_cast<int>(16 * v)},
               static_cast<int>(16 * 0.0215 * 212.8), colours[random.below(4)], cv::FILLED,
               cv::LINE_AA, 4);
  }
}

void Story::judge(int frame, const std::vector<vision::RobotPlacement>& robots,
                  const tracker::FrameReport& report) {
  std::vector<bool> seen(robots.size(), false);
  for (const tracker::RobotReport& reported : report.robots) {
    std::size_t nearest = robots.size();
    double nearest_px = kMatch_px;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const double apart_px =
          (reported.centre_px - pixel({robots[i].motion.x_m, robots[i].motion.y_m})).norm();
      if (apart_px < nearest_px && is_there(static_cast<int>(i), frame)) {
        nearest = i;
        nearest_px = apart_px;
      }
    }
    if (nearest == robots.size() || seen[nearest]) {
      ++study_.phantoms;
      continue;
    }
    seen[nearest] = true;
    const vision::RobotPlacement& truth = robots[nearest];
    if (reported.id != truth.id || reported.team != scene_.layouts[0].teams[truth.team].name) {
      ++study_.wrong_ids;
      continue;
    }
    squares_px2_ += 0.5 * nearest_px * nearest_px;
    ++matched_;
    study_.worst_error_px = std::max(study_.worst_error_px, nearest_px);
    if (!cover_of(static_cast<int>(nearest), frame).discs.empty()) ++study_.covered_found;
  }
  for (int i = 0; i < kRobots; ++i) count(i, frame, seen[static_cast<std::size_t>(i)]);
}

void Story::count(int robot, int frame, bool seen) {
  const auto i = static_cast<std::size_t>(robot);
  const bool there = is_there(robot, frame);
  study_.robot_frames += there ? 1 : 0;
  if (!there) is_new_[i] = true;
  if (seen || !there || !cover_of(robot, frame).discs.empty()) {
    unseen_[i] = 0;
  } else {
    ++unseen_[i];
  }
  if (!there || !cover_of(robot, frame).discs.empty()) return;
  ++study_.uncovered;
  if (seen) {
    is_new_[i] = false;
  } else if (is_new_[i]) {
    study_.slowest_newcomer = std::max(study_.slowest_newcomer, unseen_[i] + 1);
  } else {
    ++study_.missed;
    study_.longest_loss = std::max(study_.longest_loss, unseen_[i]);
  }
}

FollowingStudy Story::run() {
  vision::Frame frame;
  tracker::FrameReport report;
  std::vector<double> times_us;
  for (int i = 0; i < story_.frames; ++i) {
    const std::vector<vision::RobotPlacement> robots = robots_at(i);
    std::vector<vision::RobotPlacement> there;
    for (int slot = 0; slot < kRobots; ++slot) {
      if (is_there(slot, i)) there.push_back(robots[static_cast<std::size_t>(slot)]);
    }
    frame.number = static_cast<std::uint64_t>(i);
    frame.capture_time = renderer_.capture_time(frame.number);
    renderer_.render_robots(frame.number, there, frame.image);
    paint(i, robots, frame.image);
    pipeline_.process(frame, 0.0, report);
    times_us.push_back(report.stages.total_us);
    judge(i, robots, report);
  }
  const auto middle = times_us.begin() + static_cast<std::ptrdiff_t>(times_us.size() / 2);
  std::nth_element(times_us.begin(), middle, times_us.end());
  study_.frame_us = *middle;
  study_.rms_px =
      std::sqrt(squares_px2_ / static_cast<double>(std::max<std::uint64_t>(1, matched_)));
  return study_;
}

}  // namespace

FollowingStudy study_following(vision::Scene scene, const FollowingStory& story,
                               std::uint64_t seed) {
  return Story(std::move(scene), story, seed).run();
}

}  // namespace nadir::support
