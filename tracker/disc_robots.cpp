#include "tracker/disc_robots.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "vision/pixel_scale_grid.h"

namespace nadir::tracker {
namespace {

// While nobody is missed, a newcomer is found within so many frames.
constexpr int kSlices = 5;
constexpr const char* kTooFewPixels = "a disc has too few pixels to be measured";

std::vector<vision::MarkerLayout> disc_layouts(const PipelineSetup& setup) {
  std::vector<vision::MarkerLayout> layouts;
  std::ranges::copy_if(setup.layouts, std::back_inserter(layouts),
                       [](const vision::MarkerLayout& layout) { return !layout.tags; });
  return layouts;
}

AlignmentSettings alignment(const PipelineSetup& setup) {
  AlignmentSettings settings;
  settings.floor_px = setup.alignment_floor_px.value_or(settings.floor_px);
  return settings;
}

// Of two robots that claim one disc, the one with more discs has the better evidence.
bool is_better(const vision::RobotObservation& a, const vision::RobotObservation& b) {
  return std::pair(a.disc_count, a.confidence) > std::pair(b.disc_count, b.confidence);
}

bool share_a_disc(const DiscRobot& a, const DiscRobot& b) {
  if (a.layout_index == b.layout_index) return false;
  const vision::DiscObservation& disc = a.observation->discs[0];
  const double radius_px = std::sqrt(disc.expected_pixels / std::numbers::pi);
  return (disc.centre_px - b.observation->discs[0].centre_px).norm() <= radius_px;
}

}  // namespace

DiscRobots::DiscRobots(const PipelineSetup& setup, const std::vector<calibration::PlaneMap>& maps,
                       int width_px, int height_px)
    : setup_(setup),
      maps_(maps),
      height_px_(height_px),
      followed_(disc_layouts(setup), maps, width_px, height_px, alignment(setup)) {
  for (std::size_t i = 0; i < setup.layouts.size() && !setup.layouts[i].tags; ++i) {
    const vision::PixelScaleGrid scale(width_px, height_px, [&](const vision::PixelPoint& pixel) {
      return maps[i].jacobian_m_per_px(pixel);
    });
    eyes_.push_back({vision::DiscPatternDetector(setup.layouts[i], scale, setup.colours), {}});
  }
  followed_.set_mosaic(setup.mosaic);
  bands_.reserve(257);
  known_.reserve(256);
  refined_.reserve(256);
  robots_.reserve(64);
}

void DiscRobots::detect(const vision::Frame& frame) {
  if (setup_.aligns()) followed_.follow(frame);
  search(frame);
}

// All of the picture where nothing is known of it. Else a slice of it for newcomers, and the places
// of robots that were lost; only if one of those is not there, all of it.
void DiscRobots::search(const vision::Frame& frame) {
  if (!setup_.aligns() || followed_.needs_full_search()) return search_everywhere(frame);
  search_parts(frame);
  if (misses_someone()) search_everywhere(frame);
}

void DiscRobots::search_everywhere(const vision::Frame& frame) {
  bands_.assign(1, vision::RowBand{});
  for (std::size_t i = 0; i < eyes_.size(); ++i) look(i, frame);
}

// Slices reach back over their upper ends: who drives from the next one into the last one is seen.
void DiscRobots::search_parts(const vision::Frame& frame) {
  slice_ = (slice_ + 1) % kSlices;
  const int begin_px = height_px_ * slice_ / kSlices;
  const int end_px = height_px_ * (slice_ + 1) / kSlices;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    bands_.assign(1, {begin_px - followed_.farthest_since_last_frame_px(i), end_px});
    followed_.append_regions(i, bands_);
    look(i, frame);
  }
}

bool DiscRobots::misses_someone() {
  bool someone = false;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    someone = followed_.misses_someone(i, eyes_[i].seen.robots) || someone;
  }
  return someone;
}

// Robots that were found where they were expected are not looked for.
void DiscRobots::look(std::size_t eye, const vision::Frame& frame) {
  known_.clear();
  for (const FollowedRobot& robot : followed_.robots()) {
    if (robot.found && robot.layout == eye) known_.push_back(robot.aligned.centre_px);
  }
  eyes_[eye].detector.detect(frame.image, {.bands = bands_, .known = known_}, eyes_[eye].seen);
}

void DiscRobots::locate(const vision::Frame& frame, std::vector<RejectionReport>& rejected) {
  robots_.clear();
  locate_followed(rejected);
  locate_detected(frame, rejected);
  settle_shared_discs(rejected);
}

void DiscRobots::locate_followed(std::vector<RejectionReport>& rejected) {
  const std::span<const FollowedRobot> followed = followed_.robots();
  for (std::size_t i = 0; i < followed.size(); ++i) {
    const FollowedRobot& who = followed[i];
    if (!who.found) continue;
    DiscRobot robot{.layout_index = who.layout, .observation = &who.observation, .pose = {}};
    robot.followed = static_cast<int>(i);
    if (take_alignment(who.aligned, robot)) {
      robots_.push_back(robot);
    } else {
      rejected.push_back({who.aligned.centre_px, kTooFewPixels});
    }
  }
}

void DiscRobots::locate_detected(const vision::Frame& frame,
                                 std::vector<RejectionReport>& rejected) {
  refined_.clear();
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    for (const vision::RobotObservation& seen : eyes_[i].seen.robots) {
      DiscRobot robot{.layout_index = i, .observation = &seen, .pose = {}};
      if (!measure(robot)) {
        rejected.push_back({seen.discs[0].centre_px, kTooFewPixels});
        continue;
      }
      if (setup_.aligns()) refine(frame, robot);
      robots_.push_back(robot);
    }
  }
}

// The same accuracy in the first frame as in those in which a robot is followed.
void DiscRobots::refine(const vision::Frame& frame, DiscRobot& robot) {
  if (refined_.size() == refined_.capacity()) return;
  const MarkerPose detected = robot.pose;
  AlignedPose& aligned = refined_.emplace_back();
  const double metres2_per_px2 =
      std::abs(maps_[robot.layout_index].jacobian_m_per_px(detected.centre_px).determinant());
  const double deviation_px =
      std::sqrt(detected.covariance.topLeftCorner<2, 2>().trace() / metres2_per_px2);
  if (followed_.refine(frame, robot.layout_index, *robot.observation, detected.pose_world_robot,
                       detected.centre_px, deviation_px, aligned) &&
      take_alignment(aligned, robot)) {
    robot.refined = static_cast<int>(refined_.size()) - 1;
  } else {
    refined_.pop_back();
    robot.pose = detected;
  }
}

// False if the variance law does not take one of the discs for a measurement.
bool DiscRobots::take_alignment(const AlignedPose& aligned, DiscRobot& robot) const {
  MarkerPose& pose = robot.pose;
  if (setup_.source == PoseSource::kAlignedAndCounts) {
    if (!measure(robot)) return false;
  } else {
    pose.covariance = aligned.covariance;
    pose.covariance.topLeftCorner<2, 2>() +=
        maps_[robot.layout_index].calibration_covariance_m2(aligned.centre_px);
  }
  pose.pose_world_robot = aligned.pose_world_robot;
  pose.centre_px = aligned.centre_px;
  pose.chi_square_per_dof = aligned.misfit;
  return true;
}

// The pose of the discs' own centres. False if the variance law does not take one of them for a
// measurement.
bool DiscRobots::measure(DiscRobot& robot) const {
  const calibration::PlaneMap& map = maps_[robot.layout_index];
  DiscCovariances covariances_m2;
  for (std::size_t d = 0; d < static_cast<std::size_t>(robot.observation->disc_count); ++d) {
    const vision::DiscObservation& disc = robot.observation->discs[d];
    const auto covariance_m2 =
        setup_.variance.covariance_m2(disc, map.jacobian_m_per_px(disc.centre_px));
    if (!covariance_m2) return false;
    covariances_m2[d] = *covariance_m2;
  }
  robot.pose = pose_from_markers(*robot.observation, setup_.layouts[robot.layout_index], map,
                                 covariances_m2);
  return true;
}

// Each detector shares out the discs among its own robots; here two layouts claim one centre disc.
void DiscRobots::settle_shared_discs(std::vector<RejectionReport>& rejected) {
  for (std::size_t a = 0; a < robots_.size(); ++a) {
    for (std::size_t b = a + 1; b < robots_.size(); ++b) {
      if (!share_a_disc(robots_[a], robots_[b])) continue;
      const bool b_is_better = is_better(*robots_[b].observation, *robots_[a].observation);
      robots_[b_is_better ? a : b].shares_disc = true;
    }
  }
  std::erase_if(robots_, [&rejected](const DiscRobot& robot) {
    if (!robot.shares_disc) return false;
    rejected.push_back({robot.observation->discs[0].centre_px,
                        vision::reject_reason_text(vision::RejectReason::kSharedDisc)});
    return true;
  });
}

void DiscRobots::remember(const DiscRobot& robot, int id, vision::CaptureTime capture_time) {
  if (!setup_.aligns()) return;
  const vision::MarkerLayout& layout = setup_.layouts[robot.layout_index];
  const vision::RobotObservation& seen = *robot.observation;
  if (!layout.is_anonymous() &&
      layout.identities[static_cast<std::size_t>(seen.identity)].id != id) {
    return;
  }
  if (robot.followed >= 0) {
    followed_.remember_aligned(static_cast<std::size_t>(robot.followed), capture_time);
    return;
  }
  const AlignedPose* const aligned =
      robot.refined < 0 ? nullptr : &refined_[static_cast<std::size_t>(robot.refined)];
  followed_.remember_detected(robot.layout_index, seen, robot.pose.pose_world_robot, aligned,
                              capture_time);
}

void DiscRobots::end_frame(FrameReport& report) {
  followed_.end_frame();
  for (const Eye& eye : eyes_) {
    for (const vision::RejectedCandidate& candidate : eye.seen.rejected) {
      report.rejected.push_back(
          {candidate.centre_px, vision::reject_reason_text(candidate.reason)});
    }
    report.rejected_not_listed += eye.seen.rejected_not_listed;
  }
}

}  // namespace nadir::tracker
