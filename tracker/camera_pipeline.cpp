#include "tracker/camera_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "calibration/calibration_height.h"
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

}  // namespace

CameraPipeline::CameraPipeline(PipelineSetup setup, int width_px, int height_px)
    : setup_(std::move(setup)), width_px_(width_px), height_px_(height_px), tracks_(setup_.tracks) {
  calibration::check_image_size(setup_.calibration, setup_.calibration_file, width_px, height_px);
  check_team_names(setup_.layouts);
  int kinds = 0;
  for (const vision::MarkerLayout& layout : setup_.layouts) {
    maps_.push_back(calibration::map_at_height(setup_.calibration, layout.height_m));
    const vision::PixelScaleGrid scale(
        width_px, height_px,
        [this](const vision::PixelPoint& pixel) { return maps_.back().jacobian_m_per_px(pixel); });
    eyes_.push_back({vision::DiscPatternDetector(layout, scale, setup_.colours), {}, kinds});
    kinds += static_cast<int>(layout.teams.size());
  }
  sightings_.reserve(64);
  candidates_.reserve(64);
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

  detect(frame);
  const auto detected = SteadyClock::now();
  locate(report);
  const auto mapped = SteadyClock::now();
  settle_shared_discs(report);
  identify(frame.capture_time, report);
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

void CameraPipeline::detect(const vision::Frame& frame) {
  for (Eye& eye : eyes_) eye.detector.detect(frame.image, eye.seen);
}

void CameraPipeline::locate(FrameReport& report) {
  sightings_.clear();
  DiscCovariances covariances_m2;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    for (const vision::RobotObservation& robot : eyes_[i].seen.robots) {
      if (!measure_discs(robot, map(i), covariances_m2)) {
        report.rejected.push_back(
            {robot.discs[0].centre_px, "a disc has too few pixels to be measured"});
        continue;
      }
      sightings_.push_back(
          {i, &robot, pose_from_markers(robot, setup_.layouts[i], map(i), covariances_m2), false});
    }
  }
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
  const std::span<const TrackDecision> decisions = tracks_.update(capture_time, candidates_);
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const vision::PixelPoint& centre_px = sightings_[i].observation->discs[0].centre_px;
    switch (decisions[i].verdict) {
      case TrackDecision::Verdict::kReport:
        report.robots.push_back(robot_report(sightings_[i], decisions[i].id));
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
  return report;
}

}  // namespace nadir::tracker
