#include "tracker/tag_robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include "tracker/pixel_near.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

constexpr double kSmallestTag_px = 12.0;
constexpr double kFastest_mps = 4.0;         // where nothing is known of a robot's motion
constexpr double kAcceleration_mps2 = 10.0;  // with a push: what a prediction may be wrong by
constexpr double kForgotten_s = 0.25;
constexpr int kMostMissed = 1;  // frames; later it is a newcomer wherever it is
constexpr double kMargin_px = 3.0;
constexpr double kMostMargin_sides = 2.0;  // beyond, the search for newcomers is cheaper
constexpr double kFetched_sides = 0.75;    // about a tag's middle
constexpr double kMostMisshape = 0.12;     // of a side, and 1.5 px more
constexpr double kFullMargin = 38.0;       // grey levels; a decision margin that leaves no doubt
constexpr unsigned kFramesPerMosaicCheck = 64;
// Two tags tell of one robot: they agree to this share of a side, and to this angle, rad.
constexpr double kAgreement_sides = 0.1;

double seconds(vision::CaptureTime::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

fusion::PlanarPose mounted_pose(const fusion::PlanarPose& robot, const vision::TagMount& mount) {
  const double c = std::cos(robot.heading_rad);
  const double s = std::sin(robot.heading_rad);
  const Eigen::Vector2d& arm = mount.position_robot_m;
  return {robot.x_m + c * arm.x() - s * arm.y(), robot.y_m + s * arm.x() + c * arm.y(),
          fusion::wrap_angle(robot.heading_rad + mount.heading_robot_rad)};
}

std::vector<vision::TagKind> search_kinds(const std::vector<TagRobotKind>& kinds, int width_px,
                                          int height_px) {
  std::vector<vision::TagKind> result;
  for (const TagRobotKind& kind : kinds) {
    result.push_back(
        {kind.layout,
         vision::PixelScaleGrid(width_px, height_px, [&kind](const vision::PixelPoint& pixel) {
           return kind.map.jacobian_m_per_px(pixel);
         })});
    const double side_px = kind.layout.size_m * result.back().scale.largest_pixels_per_metre();
    if (side_px >= kSmallestTag_px) continue;
    throw vision::InputError(
        {}, fmt::format("tags of {:g} m are {:.1f} px wide at most", kind.layout.size_m, side_px),
        fmt::format("tags are found from {:g} px on: make them larger or hang the camera lower",
                    kSmallestTag_px));
  }
  return result;
}

}  // namespace

TagRobots::TagRobots(std::vector<TagRobotKind> kinds, int width_px, int height_px,
                     const TagSettings& settings)
    : kinds_(std::move(kinds)),
      settings_(settings),
      search_(search_kinds(kinds_, width_px, height_px)),
      sensor_(width_px, height_px) {
  for (const TagRobotKind& kind : kinds_) {
    grids_.push_back(std::make_unique<PlaneGrid>(kind.map, width_px, height_px));
    aligners_.emplace_back(kind.layout, *grids_.back(), settings_.alignment);
  }
}

void TagRobots::look_for_mosaic(const cv::Mat& image) {
  if (settings_.mosaic) {
    mosaic_ = *settings_.mosaic;
  } else if (frames_ % kFramesPerMosaicCheck == 0) {
    mosaic_ = recognise_mosaic(image);
  }
  ++frames_;
}

void TagRobots::detect(const vision::Frame& frame) {
  if (frame.capture_time < time_) memories_.clear();  // a recording that starts again
  time_ = frame.capture_time;
  std::erase_if(memories_, [this](const Memory& robot) {
    return robot.missed > kMostMissed || seconds(time_ - robot.time) > kForgotten_s;
  });
  if (settings_.aligned) look_for_mosaic(frame.image);
  sightings_.clear();
  expected_.clear();
  found_.clear();
  misshapen_.clear();
  for (std::size_t i = 0; i < memories_.size(); ++i) {
    expect(frame, memories_[i], i + 1 < memories_.size() ? &memories_[i + 1] : nullptr);
  }
  search_.search(frame.image, expected_, found_, false, seen_);
  for (const vision::TagSighting& seen : seen_.tags) take(frame.image, seen);
}

// Those that show a robot, if it has not moved.
vision::PixelFetch TagRobots::pixels_of(const cv::Mat& image, const Memory& robot) const {
  const double side_px =
      kinds_[robot.kind].layout.size_m / grids_[robot.kind]->metres_per_pixel(robot.centre_px);
  vision::PixelFetch fetch;
  fetch.add({image, robot.centre_px, kFetched_sides * side_px});
  return fetch;
}

// Where the robot's tags should be now: aligned there, or a place to search. `next`: the robot that
// comes after it, or null.
void TagRobots::expect(const vision::Frame& frame, const Memory& robot, const Memory* next) {
  const TagRobotKind& kind = kinds_[robot.kind];
  const double ahead_s = seconds(time_ - robot.time);
  const Eigen::Vector3d move = robot.velocity * ahead_s;
  const fusion::PlanarPose pose{robot.pose.x_m + move.x(), robot.pose.y_m + move.y(),
                                fusion::wrap_angle(robot.pose.heading_rad + move.z())};
  const double scale = 1.0 / grids_[robot.kind]->metres_per_pixel(robot.centre_px);
  const double side_px = kind.layout.size_m * scale;
  const double unknown_m =
      robot.has_velocity ? kAcceleration_mps2 * ahead_s * ahead_s : kFastest_mps * ahead_s;
  const double margin_px = kMargin_px + std::min(scale * unknown_m, kMostMargin_sides * side_px);
  const bool may_align = settings_.aligned && robot.has_velocity && robot.missed == 0;
  if (may_align && next != nullptr) {
    aligners_[robot.kind].fetch_meanwhile(pixels_of(frame.image, *next));
  }
  for (const vision::MountedTag& tag : robot.tags) {
    Sighting sighting{.kind = robot.kind, .robot_id = robot.id, .tag_id = tag.tag_id, .pose = {}};
    sighting.pose.mount = tag.mount;
    sighting.pose.pose_world_tag = mounted_pose(pose, tag.mount);
    sighting.pose.centre_px =
        pixel_near(kind.map, sighting.pose.pose_world_tag.position_m(), robot.centre_px);
    // One tag a frame tells of noise and blur.
    const bool teach = sightings_.size() == frames_ % std::max<std::size_t>(memories_.size(), 1);
    if (may_align && align(frame.image, sighting, teach)) {
      found_.push_back(vision::tag_box(sighting.pose.centre_px, side_px, 0.0));
      sightings_.push_back(sighting);
    } else {
      expected_.push_back({sighting.pose.centre_px, side_px, margin_px});
    }
  }
}

// Replaces the sighting's pose by that of its pixels, if they show its tag.
bool TagRobots::align(const cv::Mat& image, Sighting& sighting, bool teach) {
  const TagRobotKind& kind = kinds_[sighting.kind];
  TagAligner& aligner = aligners_[sighting.kind];
  AlignedTag aligned;
  if (!aligner.align(image, mosaic_, sensor_, sighting.tag_id, sighting.pose.pose_world_tag,
                     sighting.pose.centre_px, aligned)) {
    return false;
  }
  if (teach) aligner.teach(sensor_);
  sighting.pose.pose_world_tag = aligned.pose_world_tag;
  sighting.pose.covariance = aligned.covariance;
  sighting.pose.centre_px =
      pixel_near(kind.map, aligned.pose_world_tag.position_m(), sighting.pose.centre_px);
  const double side_px =
      kind.layout.size_m / grids_[sighting.kind]->metres_per_pixel(sighting.pose.centre_px);
  sighting.pixels = static_cast<int>(std::lround(side_px * side_px));
  sighting.confidence = aligned.explained;
  sighting.aligned = true;
  return true;
}

// A tag that was detected.
void TagRobots::take(const cv::Mat& image, const vision::TagSighting& seen) {
  const TagRobotKind& kind = kinds_[seen.kind];
  const auto tag = kind.layout.find(seen.tag.id);
  const bool known = std::ranges::any_of(sightings_, [&](const Sighting& other) {
    return other.kind == seen.kind && other.tag_id == seen.tag.id &&
           (other.pose.centre_px - seen.tag.centre_px).norm() < seen.side_px;
  });
  if (!tag || known) return;
  const TagPose pose = tag_pose(seen.tag, kind.layout.size_m, tag->mount, kind.map);
  if (pose.misshape > kMostMisshape + 1.5 / seen.side_px) {
    misshapen_.push_back({pose.centre_px, "tag is no square on the plane of the tags"});
    return;
  }
  const double certain = std::min(1.0, seen.tag.decision_margin / kFullMargin);
  // A bit that was corrected halves it.
  Sighting sighting{
      .kind = seen.kind,
      .robot_id = tag->robot_id,
      .tag_id = tag->tag_id,
      .pose = pose,
      .pixels = static_cast<int>(std::lround(seen.side_px * seen.side_px)),
      .confidence = std::max(0.3, certain) * (seen.tag.corrected_bits == 0 ? 1.0 : 0.5)};
  if (settings_.aligned) align(image, sighting, true);
  sightings_.push_back(sighting);
}

void TagRobots::locate(std::vector<RejectionReport>& rejected) {
  rejected.insert(rejected.end(), misshapen_.begin(), misshapen_.end());
  for (const vision::RejectedCandidate& candidate : seen_.rejected) {
    rejected.push_back({candidate.centre_px, vision::reject_reason_text(candidate.reason)});
  }
  // The surest tag of a robot first: it decides which others agree with it.
  std::ranges::sort(sightings_, [](const Sighting& a, const Sighting& b) {
    return std::tie(b.confidence, a.kind, a.tag_id) < std::tie(a.confidence, b.kind, b.tag_id);
  });
  robots_.clear();
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    if (!sightings_[i].taken) robots_.push_back(robot_of(i));
  }
  std::ranges::sort(robots_, [](const TagRobot& a, const TagRobot& b) {
    return std::tie(b.tag_count, b.confidence, a.layout_index, a.id) <
           std::tie(a.tag_count, a.confidence, b.layout_index, b.id);
  });
  remember();
}

// The robot of one tag and of all others that agree with it.
TagRobot TagRobots::robot_of(std::size_t first) {
  const Sighting& lead = sightings_[first];
  const TagRobotKind& kind = kinds_[lead.kind];
  TagRobot robot;
  robot.layout_index = kind.layout_index;
  robot.id = lead.robot_id;
  robot.confidence = lead.confidence;
  fused_.clear();
  const fusion::PlanarPose pose =
      pose_from_tags(std::span(&lead.pose, 1), kind.map).pose_world_robot;
  for (std::size_t i = first; i < sightings_.size(); ++i) {
    Sighting& tag = sightings_[i];
    if (tag.taken || tag.kind != lead.kind || tag.robot_id != lead.robot_id) continue;
    const fusion::PlanarPose own =
        pose_from_tags(std::span(&tag.pose, 1), kind.map).pose_world_robot;
    const double apart_m = (own.position_m() - pose.position_m()).norm();
    const double lever_m = tag.pose.mount.position_robot_m.norm();
    const double turned_rad = std::abs(fusion::wrap_angle(own.heading_rad - pose.heading_rad));
    const double limit_m = kAgreement_sides * (kind.layout.size_m + lever_m);
    if (i != first && (apart_m > limit_m || turned_rad > kAgreement_sides)) continue;
    tag.taken = true;
    fused_.push_back(tag.pose);
    robot.aligned = robot.aligned && tag.aligned;
    if (robot.tag_count < vision::kMaxDiscs) {
      robot.pixels[static_cast<std::size_t>(robot.tag_count++)] = tag.pixels;
    }
  }
  robot.pose = pose_from_tags(fused_, kind.map);
  return robot;
}

void TagRobots::remember() {
  for (Memory& memory : memories_) ++memory.missed;
  for (const TagRobot& robot : robots_) {
    const auto kind = static_cast<std::size_t>(
        std::ranges::find(kinds_, robot.layout_index, &TagRobotKind::layout_index) -
        kinds_.begin());
    auto memory = std::ranges::find_if(
        memories_, [&](const Memory& each) { return each.kind == kind && each.id == robot.id; });
    if (memory == memories_.end()) {
      memories_.push_back({});
      memory = memories_.end() - 1;
      memory->kind = kind;
      memory->id = robot.id;
      memory->tags = kinds_[kind].layout.tags_of(robot.id);
    } else if (memory->time == time_) {
      continue;  // a second claim of the number
    }
    const double passed_s = seconds(time_ - memory->time);
    const fusion::PlanarPose& now = robot.pose.pose_world_robot;
    const double moved_m = (now.position_m() - memory->pose.position_m()).norm();
    memory->has_velocity = passed_s > 0.0 && moved_m < kFastest_mps * passed_s &&
                           memory->time != vision::CaptureTime{};
    if (memory->has_velocity) {
      memory->velocity << (now.position_m() - memory->pose.position_m()) / passed_s,
          fusion::wrap_angle(now.heading_rad - memory->pose.heading_rad) / passed_s;
    } else {
      memory->velocity.setZero();
    }
    memory->pose = now;
    memory->centre_px = robot.pose.centre_px;
    memory->time = time_;
    memory->missed = 0;
  }
}

}  // namespace nadir::tracker
