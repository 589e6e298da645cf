#include "tracker/camera_pipeline.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "calibration/calibration_height.h"
#include "tracker/tag_report.h"
#include "vision/input/input_error.h"
#include "vision/pixel_scale_grid.h"

namespace nadir::tracker {
namespace {

using SteadyClock = std::chrono::steady_clock;

double microseconds(SteadyClock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

void check_team_names(const std::vector<vision::MarkerLayout>& layouts) {
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const vision::Team& team : layouts[i].teams) {
        for (const vision::Team& other : layouts[j].teams) {
          if (team.name != other.name) continue;
          throw vision::InputError(
              {layouts[i].name, 0, 0},
              fmt::format("layouts '{}' and '{}' both have a team '{}'", layouts[j].name,
                          layouts[i].name, team.name),
              "give one of the teams another name: robots are told apart by team and number");
        }
      }
    }
  }
}

// Of two robots that claim one disc, the one with more discs has the better evidence.
bool is_better(const vision::RobotObservation& a, const vision::RobotObservation& b) {
  return std::pair(a.disc_count, a.confidence) > std::pair(b.disc_count, b.confidence);
}

// While nobody is missed, a newcomer is found within so many frames.
constexpr int kSlices = 5;

std::vector<calibration::PlaneMap> maps_of(const PipelineSetup& setup) {
  std::vector<calibration::PlaneMap> maps;
  for (const vision::MarkerLayout& layout : setup.layouts) {
    maps.push_back(calibration::map_at_height(setup.calibration, layout.height_m));
  }
  return maps;
}

// Layouts with tags come last: so an index counts discs' layouts alone and all of them.
PipelineSetup checked(PipelineSetup setup, int width_px, int height_px) {
  calibration::check_image_size(setup.calibration, setup.calibration_file, width_px, height_px);
  check_team_names(setup.layouts);
  std::ranges::stable_partition(setup.layouts,
                                [](const vision::MarkerLayout& layout) { return !layout.tags; });
  return setup;
}

std::vector<vision::MarkerLayout> disc_layouts(const PipelineSetup& setup) {
  std::vector<vision::MarkerLayout> layouts;
  std::ranges::copy_if(setup.layouts, std::back_inserter(layouts),
                       [](const vision::MarkerLayout& layout) { return !layout.tags; });
  return layouts;
}

AlignmentSettings disc_alignment(const PipelineSetup& setup) {
  AlignmentSettings settings;
  settings.floor_px = setup.alignment_floor_px.value_or(settings.floor_px);
  return settings;
}

TagAlignmentSettings tag_alignment(const PipelineSetup& setup) {
  TagAlignmentSettings settings;
  settings.floor_px = setup.alignment_floor_px.value_or(settings.floor_px);
  return settings;
}

}  // namespace

CameraPipeline::CameraPipeline(PipelineSetup setup, int width_px, int height_px)
    : setup_(checked(std::move(setup), width_px, height_px)),
      width_px_(width_px),
      height_px_(height_px),
      maps_(maps_of(setup_)),
      followed_(disc_layouts(setup_), maps_, width_px, height_px, disc_alignment(setup_)),
      tracks_(setup_.tracks) {
  int kinds = 0;
  for (std::size_t i = 0; i < setup_.layouts.size(); ++i) {
    const vision::MarkerLayout& layout = setup_.layouts[i];
    if (layout.tags) break;
    const vision::PixelScaleGrid scale(width_px, height_px, [&](const vision::PixelPoint& pixel) {
      return maps_[i].jacobian_m_per_px(pixel);
    });
    eyes_.push_back({vision::DiscPatternDetector(layout, scale, setup_.colours), {}, kinds});
    kinds += static_cast<int>(layout.teams.size());
  }
  make_tags(kinds);
  followed_.set_mosaic(setup_.mosaic);
  known_.reserve(256);
  refined_.reserve(256);
  sightings_.reserve(64);
  candidates_.reserve(64);
}

void CameraPipeline::make_tags(int first_kind) {
  tag_kind_ = first_kind - static_cast<int>(eyes_.size());
  std::vector<TagRobotKind> kinds;
  for (std::size_t i = eyes_.size(); i < setup_.layouts.size(); ++i) {
    kinds.push_back({*setup_.layouts[i].tags, maps_[i], i});
  }
  if (!kinds.empty()) {
    tags_.emplace(
        std::move(kinds), width_px_, height_px_,
        TagSettings{setup_.source != PoseSource::kDetector, setup_.mosaic, tag_alignment(setup_)});
  }
}

void CameraPipeline::process(const vision::Frame& frame, double read_us, FrameReport& report) {
  check_size(frame);
  const auto start = SteadyClock::now();
  report.frame = frame.number;
  report.camera = setup_.camera;
  report.capture_ns = frame.capture_time.time_since_epoch().count();
  report.robots.clear();
  report.rejected.clear();
  report.rejected_not_listed = 0;

  if (setup_.source != PoseSource::kDetector) followed_.follow(frame);
  search(frame);
  if (tags_) tags_->detect(frame);
  const auto detected = SteadyClock::now();
  locate_followed(report);
  locate_detected(frame, report);
  if (tags_) tags_->locate(report.rejected);
  const auto mapped = SteadyClock::now();
  settle_shared_discs(report);
  identify(frame.capture_time, report);
  followed_.end_frame();
  report_rejected(report);

  report.stages.read_us = read_us;
  report.stages.detect_us = microseconds(detected - start);
  report.stages.map_us = microseconds(mapped - detected);
  report.stages.total_us = microseconds(SteadyClock::now() - start);
}

void CameraPipeline::check_size(const vision::Frame& frame) const {
  if (frame.image.cols == width_px_ && frame.image.rows == height_px_) return;
  throw vision::InputError(
      {setup_.camera, 0, 0},
      fmt::format("frame {} has {}x{} pixels, those before had {}x{}", frame.number,
                  frame.image.cols, frame.image.rows, width_px_, height_px_),
      "let a camera deliver frames of one size");
}

// All of the picture where a robot is missed or new, else a slice of it. Robots that were found
// where they were expected are not looked for.
void CameraPipeline::search(const vision::Frame& frame) {
  vision::SearchArea area;
  if (setup_.source != PoseSource::kDetector && !followed_.needs_full_search()) {
    slice_ = (slice_ + 1) % kSlices;
    area.row_begin_px = height_px_ * slice_ / kSlices;
    area.row_end_px = height_px_ * (slice_ + 1) / kSlices;
  }
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    known_.clear();
    for (const FollowedRobot& robot : followed_.robots()) {
      if (robot.found && robot.layout == i) known_.push_back(robot.aligned.centre_px);
    }
    area.known = known_;
    eyes_[i].detector.detect(frame.image, area, eyes_[i].seen);
  }
}

void CameraPipeline::locate_followed(FrameReport& report) {
  sightings_.clear();
  const std::span<const FollowedRobot> robots = followed_.robots();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const FollowedRobot& robot = robots[i];
    if (!robot.found) continue;
    Sighting sighting{.layout = robot.layout, .observation = &robot.observation, .pose = {}};
    sighting.followed = static_cast<int>(i);
    if (!take_alignment(robot.aligned, robot.observation, robot.layout, sighting.pose)) {
      report.rejected.push_back(
          {robot.aligned.centre_px, "a disc has too few pixels to be measured"});
      continue;
    }
    sightings_.push_back(sighting);
  }
}

void CameraPipeline::locate_detected(const vision::Frame& frame, FrameReport& report) {
  refined_.clear();
  DiscCovariances covariances_m2;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    for (const vision::RobotObservation& robot : eyes_[i].seen.robots) {
      if (!measure_discs(robot, map(i), covariances_m2)) {
        report.rejected.push_back(
            {robot.discs[0].centre_px, "a disc has too few pixels to be measured"});
        continue;
      }
      Sighting sighting{.layout = i, .observation = &robot, .pose = {}};
      sighting.pose = pose_from_markers(robot, setup_.layouts[i], map(i), covariances_m2);
      if (setup_.source != PoseSource::kDetector) refine(frame, sighting);
      sightings_.push_back(sighting);
    }
  }
}

// The same accuracy in the first frame as in those in which a robot is followed.
void CameraPipeline::refine(const vision::Frame& frame, Sighting& sighting) {
  if (refined_.size() == refined_.capacity()) return;
  const vision::RobotObservation& robot = *sighting.observation;
  const MarkerPose detected = sighting.pose;
  AlignedPose& aligned = refined_.emplace_back();
  const double deviation_px =
      std::sqrt(detected.covariance.topLeftCorner<2, 2>().trace() /
                std::abs(map(sighting.layout).jacobian_m_per_px(detected.centre_px).determinant()));
  if (followed_.refine(frame, sighting.layout, robot, detected.pose_world_robot, detected.centre_px,
                       deviation_px, aligned) &&
      take_alignment(aligned, robot, sighting.layout, sighting.pose)) {
    sighting.aligned = static_cast<int>(refined_.size()) - 1;
  } else {
    refined_.pop_back();
    sighting.pose = detected;
  }
}

// False if the variance law does not take one of the discs for a measurement.
bool CameraPipeline::take_alignment(const AlignedPose& aligned,
                                    const vision::RobotObservation& robot, std::size_t layout,
                                    MarkerPose& pose) const {
  if (setup_.source == PoseSource::kAlignedAndCounts) {
    DiscCovariances covariances_m2;
    if (!measure_discs(robot, map(layout), covariances_m2)) return false;
    pose = pose_from_markers(robot, setup_.layouts[layout], map(layout), covariances_m2);
  } else {
    pose.covariance = aligned.covariance;
    pose.covariance.topLeftCorner<2, 2>() +=
        map(layout).calibration_covariance_m2(aligned.centre_px);
  }
  pose.pose_world_robot = aligned.pose_world_robot;
  pose.centre_px = aligned.centre_px;
  pose.chi_square_per_dof = aligned.misfit;
  return true;
}

// False if the variance law does not take one of the discs for a measurement.
bool CameraPipeline::measure_discs(const vision::RobotObservation& robot,
                                   const calibration::PlaneMap& map,
                                   DiscCovariances& covariances_m2) const {
  for (std::size_t d = 0; d < static_cast<std::size_t>(robot.disc_count); ++d) {
    const vision::DiscObservation& disc = robot.discs[d];
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(disc.centre_px);
    const auto covariance_m2 = setup_.variance.covariance_m2(disc, jacobian);
    if (!covariance_m2) return false;
    covariances_m2[d] = *covariance_m2;
  }
  return true;
}

// Each detector shares out the discs among its own robots; here two layouts claim one centre disc.
void CameraPipeline::settle_shared_discs(FrameReport& report) {
  for (std::size_t a = 0; a < sightings_.size(); ++a) {
    for (std::size_t b = a + 1; b < sightings_.size(); ++b) {
      if (sightings_[a].layout == sightings_[b].layout) continue;
      const vision::DiscObservation& disc = sightings_[a].observation->discs[0];
      const double radius_px = std::sqrt(disc.expected_pixels / 3.14159265358979323846);
      const auto& other = sightings_[b].observation->discs[0];
      if ((disc.centre_px - other.centre_px).norm() > radius_px) continue;
      const bool b_is_better = is_better(*sightings_[b].observation, *sightings_[a].observation);
      sightings_[b_is_better ? a : b].shares_disc = true;
    }
  }
  std::erase_if(sightings_, [&report](const Sighting& sighting) {
    if (!sighting.shares_disc) return false;
    report.rejected.push_back({sighting.observation->discs[0].centre_px,
                               vision::reject_reason_text(vision::RejectReason::kSharedDisc)});
    return true;
  });
}

void CameraPipeline::identify(vision::CaptureTime capture_time, FrameReport& report) {
  candidates_.clear();
  for (const Sighting& sighting : sightings_) {
    const vision::MarkerLayout& layout = setup_.layouts[sighting.layout];
    const vision::RobotObservation& robot = *sighting.observation;
    candidates_.push_back(
        {.kind = eyes_[sighting.layout].first_kind + robot.team,
         .read_id = layout.is_anonymous()
                        ? -1
                        : layout.identities[static_cast<std::size_t>(robot.identity)].id,
         .pose_world_robot = sighting.pose.pose_world_robot,
         .covariance = sighting.pose.covariance,
         .confidence = robot.confidence});
  }
  if (tags_) {
    for (const TagRobot& robot : tags_->robots()) {
      candidates_.push_back(
          track_candidate(robot, tag_kind_ + static_cast<int>(robot.layout_index)));
    }
  }
  const std::span<const TrackDecision> decisions = tracks_.update(capture_time, candidates_);
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const bool has_discs = i < sightings_.size();
    const TagRobot* const tagged = has_discs ? nullptr : &tags_->robots()[i - sightings_.size()];
    const vision::PixelPoint& centre_px =
        has_discs ? sightings_[i].observation->discs[0].centre_px : tagged->pose.centre_px;
    switch (decisions[i].verdict) {
      case TrackDecision::Verdict::kReport:
        if (tagged != nullptr) {
          const vision::MarkerLayout& layout = setup_.layouts[tagged->layout_index];
          report.robots.push_back(
              nadir::tracker::robot_report(*tagged, decisions[i].id, layout.teams.front().name));
          break;
        }
        report.robots.push_back(robot_report(sightings_[i], decisions[i].id));
        remember(sightings_[i], decisions[i].id, capture_time);
        break;
      case TrackDecision::Verdict::kDuplicate:
        report.rejected.push_back(
            {centre_px, vision::reject_reason_text(vision::RejectReason::kDuplicateIdentity)});
        break;
      case TrackDecision::Verdict::kUncertain:
        report.rejected.push_back({centre_px, "its number is not certain yet"});
        break;
    }
  }
}

// Followed is only who is reported under the number that is read from it.
void CameraPipeline::remember(const Sighting& sighting, int id, vision::CaptureTime capture_time) {
  if (setup_.source == PoseSource::kDetector) return;
  const vision::MarkerLayout& layout = setup_.layouts[sighting.layout];
  const vision::RobotObservation& robot = *sighting.observation;
  if (!layout.is_anonymous() &&
      layout.identities[static_cast<std::size_t>(robot.identity)].id != id) {
    return;
  }
  if (sighting.followed >= 0) {
    followed_.remember_aligned(static_cast<std::size_t>(sighting.followed), capture_time);
    return;
  }
  const AlignedPose* const aligned =
      sighting.aligned < 0 ? nullptr : &refined_[static_cast<std::size_t>(sighting.aligned)];
  followed_.remember_detected(sighting.layout, robot, sighting.pose.pose_world_robot, aligned,
                              capture_time);
}

void CameraPipeline::report_rejected(FrameReport& report) const {
  for (const Eye& eye : eyes_) {
    for (const vision::RejectedCandidate& candidate : eye.seen.rejected) {
      report.rejected.push_back(
          {candidate.centre_px, vision::reject_reason_text(candidate.reason)});
    }
    report.rejected_not_listed += eye.seen.rejected_not_listed;
  }
}

RobotReport CameraPipeline::robot_report(const Sighting& sighting, int id) const {
  const vision::RobotObservation& robot = *sighting.observation;
  RobotReport report;
  report.id = id;
  report.team = setup_.layouts[sighting.layout].teams[static_cast<std::size_t>(robot.team)].name;
  report.pose_world_robot = sighting.pose.pose_world_robot;
  report.covariance = sighting.pose.covariance;
  report.centre_px = sighting.pose.centre_px;
  report.marker_count = robot.disc_count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(robot.disc_count); ++i) {
    report.pixels[i] = static_cast<int>(std::lround(robot.discs[i].pixels));
  }
  report.confidence = robot.confidence;
  report.aligned = sighting.followed >= 0 || sighting.aligned >= 0;
  return report;
}

}  // namespace nadir::tracker
