#include "tracker/followed_robots.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "tracker/alignment/robot_place.h"
#include "tracker/alignment/sensor_lesson.h"

namespace nadir::tracker {
namespace {

constexpr int kSightingsToFollow = 3;
constexpr int kSearchesAfterLoss = 2;
constexpr double kLongestPrediction_s = 0.2;
constexpr double kRemembered_s =
    0.5;  // where a lost robot was: something may lie on it for a while
constexpr double kFastest_mps = 4.0;
constexpr double kMostStray_m = 0.3;   // looked for; a newcomer's search finds it elsewhere
constexpr double kSameRobot_m = 0.05;  // between expected and detected place
constexpr double kLookMemory = 0.95;   // per frame
constexpr unsigned kFramesPerMosaicCheck = 64;  // a camera keeps its sensor
constexpr double kKnownBlur_px = 0.005;
constexpr unsigned kRobotsPerLesson = 4;
constexpr double kAgreement_sigmas = 6.0;
constexpr double kAgreement_px = 1.0;
constexpr double kEdge_px = 2.5;   // a blurred one, about
constexpr double kPoor_px = 0.02;  // under a shadow's edge the detector is as good

double seconds(vision::CaptureTime::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

// Of the position, both axes together.
double deviation_of(const AlignedPose& aligned, const PlaneGrid& grid) {
  return std::sqrt(aligned.covariance.topLeftCorner<2, 2>().trace()) /
         grid.metres_per_pixel(aligned.centre_px);
}

Eigen::Vector3d vector_of(const fusion::PlanarPose& pose) {
  return {pose.x_m, pose.y_m, pose.heading_rad};
}

}  // namespace

FollowedRobots::FollowedRobots(const std::vector<vision::MarkerLayout>& layouts,
                               const std::vector<calibration::PlaneMap>& maps, int width_px,
                               int height_px, const AlignmentSettings& settings)
    : layouts_(layouts), sensor_(width_px, height_px) {
  for (std::size_t i = 0; i < layouts_.size(); ++i) {
    grids_.push_back(std::make_unique<PlaneGrid>(maps[i], width_px, height_px));
    aligners_.emplace_back(layouts_[i], *grids_.back(), settings);
  }
  robots_.reserve(256);
  obstacles_.reserve(256);
}

void FollowedRobots::look_for_mosaic(const cv::Mat& image) {
  if (stated_mosaic_) {
    mosaic_ = *stated_mosaic_;
  } else if (frames_ % kFramesPerMosaicCheck == 0) {
    mosaic_ = recognise_mosaic(image);
  }
  ++frames_;
}

PoseGuess FollowedRobots::predict(const FollowedRobot& robot, vision::CaptureTime now) const {
  const double ahead_s = std::min(seconds(now - robot.last_seen), kLongestPrediction_s);
  const Eigen::Vector3d expected = vector_of(robot.pose) + robot.rate * ahead_s;
  return {{expected.x(), expected.y(), fusion::wrap_angle(expected.z())}, robot.aligned.centre_px};
}

void FollowedRobots::follow(const vision::Frame& frame) {
  look_for_mosaic(frame.image);
  gap_s_ = seconds(frame.capture_time - last_frame_);
  last_frame_ = frame.capture_time;
  if (gap_s_ <= 0.0 || gap_s_ > kLongestPrediction_s) {
    robots_.clear();
    full_searches_due_ = kSearchesAfterLoss;
  }
  needs_full_search_ = full_searches_due_ > 0;
  full_searches_due_ = std::max(0, full_searches_due_ - 1);
  aligned_in_frame_ = 0;
  for (FollowedRobot& robot : robots_) {
    robot.found = false;
    robot.continued = false;
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    FollowedRobot& robot = robots_[i];
    if (robot.sightings < kSightingsToFollow) continue;
    if (i + 1 < robots_.size()) {
      aligners_[robot.layout].fetch_meanwhile(pixels_of(frame.image, robots_[i + 1]));
    }
    align(frame, robot);
    if (!robot.found) robot.sightings = 0;
  }
}

vision::PixelPoint FollowedRobots::expected_px(const FollowedRobot& robot) const {
  const vision::PixelPoint& last_px = robot.aligned.centre_px;
  return grids_[robot.layout]
      ->pixel_near(predict(robot, last_frame_).pose_world_robot.position_m(), last_px)
      .value_or(last_px);
}

double FollowedRobots::search_radius_px(const FollowedRobot& robot) const {
  const double stray_m =
      std::min(kMostStray_m, kSameRobot_m + kFastest_mps * seconds(last_frame_ - robot.last_seen));
  return stray_m / grids_[robot.layout]->metres_per_pixel(robot.aligned.centre_px);
}

int FollowedRobots::farthest_since_last_frame_px(std::size_t layout) const {
  return static_cast<int>(std::ceil(kFastest_mps * gap_s_ / grids_[layout]->finest_m_per_px()));
}

// Where the discs of a robot that was lost or is new may be.
void FollowedRobots::append_regions(std::size_t layout, std::vector<vision::RowBand>& bands) const {
  for (const FollowedRobot& robot : robots_) {
    if (robot.found || robot.layout != layout) continue;
    const double row_px = expected_px(robot).y();
    const double half_px = search_radius_px(robot);
    bands.push_back({static_cast<int>(row_px - half_px), static_cast<int>(row_px + half_px) + 1});
  }
}

bool FollowedRobots::misses_someone(std::size_t layout,
                                    std::span<const vision::RobotObservation> seen) {
  const auto is_missed = [&](const FollowedRobot& robot) {
    if (robot.found || robot.layout != layout || robot.missed > 0) return false;
    const vision::PixelPoint expected = expected_px(robot);
    const double radius_px = search_radius_px(robot);
    return std::ranges::none_of(seen, [&](const vision::RobotObservation& one) {
      return one.team == robot.team && one.identity == robot.identity &&
             (one.discs[0].centre_px - expected).norm() < 2.0 * radius_px;
    });
  };
  if (std::ranges::none_of(robots_, is_missed)) return false;
  full_searches_due_ = kSearchesAfterLoss - 1;
  return true;
}

// Those that will show a robot's discs.
vision::PixelFetch FollowedRobots::pixels_of(const cv::Mat& image,
                                             const FollowedRobot& robot) const {
  const vision::PixelPoint& last_px = robot.aligned.centre_px;
  const LocalPlane about = grids_[robot.layout]->about(static_cast<int>(std::lround(last_px.x())),
                                                       static_cast<int>(std::lround(last_px.y())));
  const Eigen::Matrix2d px_per_m = about.slope.inverse();
  const double scale_px_per_m = std::sqrt(std::abs(px_per_m.determinant()));
  const RobotPlace place(predict(robot, last_frame_).pose_world_robot);
  const DiscTemplate& discs = aligners_[robot.layout].robot();
  vision::PixelFetch fetch;
  for (std::size_t i = 0; i < static_cast<std::size_t>(discs.disc_count); ++i) {
    const Eigen::Vector2d away_m = place.point(discs.place_m[i]) - robot.pose.position_m();
    const vision::PixelPoint centre_px = last_px + px_per_m * away_m;
    fetch.add({image, centre_px, scale_px_per_m * discs.radius_m[i] + kEdge_px});
    grids_[robot.layout]->fetch(centre_px);
  }
  return fetch;
}

// Plates of the other robots of a layout, where they are by now or are expected.
void FollowedRobots::list_obstacles(std::size_t layout, const Eigen::Vector2d& except_m) {
  obstacles_.clear();
  const double radius_m = aligners_[layout].robot().plate.radius_m;
  for (const FollowedRobot& other : robots_) {
    if (other.layout != layout || other.missed > 0) continue;
    const Eigen::Vector2d place_m = other.found
                                        ? other.aligned.pose_world_robot.position_m()
                                        : predict(other, last_frame_).pose_world_robot.position_m();
    if ((place_m - except_m).norm() < radius_m) continue;  // itself: two robots have no room there
    obstacles_.push_back({place_m, radius_m});
  }
}

void FollowedRobots::align(const vision::Frame& frame, FollowedRobot& robot) {
  const PoseGuess guess = predict(robot, frame.capture_time);
  list_obstacles(robot.layout, guess.pose_world_robot.position_m());
  robot.found = aligners_[robot.layout].align(frame.image, mosaic_, sensor_, guess, &robot.look,
                                              obstacles_, robot.aligned);
  if (robot.found && robot.aligned.uneven_light &&
      deviation_of(robot.aligned, *grids_[robot.layout]) > kPoor_px) {
    robot.found = false;  // the detector shall measure it in this frame
  }
  if (!robot.found) return;
  teach(frame.image, robot.layout);
  observe(robot);
}

// What was aligned, in the detector's words.
void FollowedRobots::observe(FollowedRobot& robot) const {
  const vision::MarkerLayout& layout = layouts_[robot.layout];
  const PlaneGrid& grid = *grids_[robot.layout];
  const double m_per_px = grid.metres_per_pixel(robot.aligned.centre_px);
  for (int i = 0; i < robot.observation.disc_count; ++i) {
    const vision::Disc disc = layout.disc(i, robot.team, std::max(0, robot.identity));
    const AlignedDisc& aligned = robot.aligned.discs[static_cast<std::size_t>(i)];
    vision::DiscObservation& seen = robot.observation.discs[static_cast<std::size_t>(i)];
    seen.centre_px = aligned.centre_px;
    seen.expected_pixels = M_PI * disc.radius_m * disc.radius_m / (m_per_px * m_per_px);
    seen.pixels = aligned.counts ? aligned.pixels : 0.0;
    seen.contrast = aligned.contrast.norm();
  }
}

bool FollowedRobots::refine(const vision::Frame& frame, std::size_t layout,
                            const vision::RobotObservation& observation,
                            const fusion::PlanarPose& detected, const vision::PixelPoint& centre_px,
                            double deviation_px, AlignedPose& result) {
  list_obstacles(layout, detected.position_m());
  if (!aligners_[layout].align(frame.image, mosaic_, sensor_, {detected, centre_px}, nullptr,
                               obstacles_, result) ||
      result.counting_discs < observation.disc_count) {
    return false;
  }
  const double apart_px = (result.centre_px - centre_px).norm();
  if (apart_px > std::max(kAgreement_px, kAgreement_sigmas * deviation_px)) return false;
  // Across a shadow's edge soft-weighted blobs may be the better measurement; two discs have no
  // others that outvote them.
  if (result.uneven_light && result.counting_discs < 3) return false;
  if (result.uneven_light && deviation_of(result, *grids_[layout]) > deviation_px) return false;
  teach(frame.image, layout);
  return true;
}

// Every robot teaches while little is known of the camera, later every fourth, by turns.
void FollowedRobots::teach(const cv::Mat& image, std::size_t layout) {
  const bool is_known = sensor_.blur_deviation_px() < kKnownBlur_px;
  const auto lesson = lesson_due(frames_, aligned_in_frame_++, is_known ? kRobotsPerLesson : 1);
  if (lesson) aligners_[layout].teach(image, mosaic_, *lesson, sensor_);
}

void FollowedRobots::remember_aligned(std::size_t index, vision::CaptureTime now) {
  FollowedRobot& robot = robots_[index];
  const double passed_s = seconds(now - robot.last_seen);
  const fusion::PlanarPose& pose = robot.aligned.pose_world_robot;
  robot.rate = fusion::pose_difference(pose, robot.pose) / passed_s;
  robot.pose = pose;
  robot.last_seen = now;
  robot.continued = true;
  for (int i = 0; i < robot.observation.disc_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!robot.aligned.discs[k].counts) continue;
    robot.look.contrast[k] = kLookMemory * robot.look.contrast[k] +
                             (1.0 - kLookMemory) * robot.aligned.discs[k].contrast;
  }
}

void FollowedRobots::remember_detected(std::size_t layout,
                                       const vision::RobotObservation& observation,
                                       const fusion::PlanarPose& pose, const AlignedPose* aligned,
                                       vision::CaptureTime now) {
  const auto same = [&](const FollowedRobot& robot) {
    return !robot.continued && robot.layout == layout && robot.team == observation.team &&
           robot.identity == observation.identity &&
           (predict(robot, now).pose_world_robot.position_m() - pose.position_m()).norm() <
               kSameRobot_m;
  };
  // One that was carried away, and is here now.
  const auto same_name = [&](const FollowedRobot& robot) {
    return !robot.continued && robot.layout == layout && robot.team == observation.team &&
           robot.identity == observation.identity && robot.identity >= 0;
  };
  auto found = std::ranges::find_if(robots_, same);
  if (found == robots_.end()) {
    found = std::ranges::find_if(robots_, same_name);
    if (found == robots_.end()) {
      if (robots_.size() == robots_.capacity()) return;
      robots_.emplace_back();
      found = robots_.end() - 1;
    }
    *found = {};
    found->layout = layout;
    found->team = observation.team;
    found->identity = observation.identity;
  } else {
    found->rate = fusion::pose_difference(pose, found->pose) /
                  std::max(1e-6, seconds(now - found->last_seen));
  }
  found->pose = pose;
  found->last_seen = now;
  found->continued = true;
  found->observation = observation;
  // A robot that cannot be aligned where it was detected is detected again.
  found->sightings = aligned != nullptr ? found->sightings + 1 : 0;
  if (aligned == nullptr) {
    found->aligned.centre_px = observation.discs[0].centre_px;
    return;
  }
  found->aligned = *aligned;
  for (int i = 0; i < observation.disc_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    found->look.contrast[k] = aligned->discs[k].contrast;
  }
}

void FollowedRobots::end_frame() {
  std::erase_if(robots_, [this](const FollowedRobot& robot) {
    return seconds(last_frame_ - robot.last_seen) > kRemembered_s;
  });
  for (FollowedRobot& robot : robots_) {
    robot.missed = robot.continued ? 0 : robot.missed + 1;
    if (!robot.continued) robot.sightings = 0;
  }
}

}  // namespace nadir::tracker
