#include "tracker/camera_pipeline.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "tracker/disc_report.h"
#include "tracker/tag_report.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

using SteadyClock = std::chrono::steady_clock;

double microseconds(SteadyClock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

void begin(const std::string& camera, const vision::Frame& frame, FrameReport& report) {
  report.frame = frame.number;
  report.camera = camera;
  report.capture_ns = frame.capture_time.time_since_epoch().count();
  report.robots.clear();
  report.rejected.clear();
  report.rejected_not_listed = 0;
}

// Robots of different layouts and teams are never the same robot.
std::vector<int> first_kinds(const PipelineSetup& setup) {
  std::vector<int> kinds;
  int next = 0;
  for (const vision::MarkerLayout& layout : setup.layouts) {
    kinds.push_back(next);
    next += static_cast<int>(layout.teams.size());
  }
  return kinds;
}

std::optional<TagRobots> tag_robots(const PipelineSetup& setup,
                                    const std::vector<calibration::PlaneMap>& maps, int width_px,
                                    int height_px) {
  std::vector<TagRobotKind> kinds;
  for (std::size_t i = 0; i < setup.layouts.size(); ++i) {
    if (setup.layouts[i].tags) kinds.push_back({*setup.layouts[i].tags, maps[i], i});
  }
  if (kinds.empty()) return std::nullopt;
  TagSettings settings{.aligned = setup.aligns(), .mosaic = setup.mosaic};
  settings.alignment.floor_px = setup.alignment_floor_px.value_or(settings.alignment.floor_px);
  return std::optional<TagRobots>(std::in_place, std::move(kinds), width_px, height_px, settings);
}

}  // namespace

CameraPipeline::CameraPipeline(PipelineSetup setup, int width_px, int height_px)
    : setup_(checked(std::move(setup), width_px, height_px)),
      width_px_(width_px),
      height_px_(height_px),
      maps_(maps_of(setup_)),
      first_kind_(first_kinds(setup_)),
      discs_(setup_, maps_, width_px, height_px),
      tags_(tag_robots(setup_, maps_, width_px, height_px)),
      tracks_(setup_.tracks) {
  candidates_.reserve(64);
}

void CameraPipeline::process(const vision::Frame& frame, double read_us, FrameReport& report) {
  check_size(frame);
  const auto start = SteadyClock::now();
  begin(setup_.camera, frame, report);

  discs_.detect(frame);
  if (tags_) tags_->detect(frame);
  const auto detected = SteadyClock::now();

  discs_.locate(frame, report.rejected);
  if (tags_) tags_->locate(report.rejected);
  const auto mapped = SteadyClock::now();

  identify(frame.capture_time, report);
  discs_.end_frame(report);
  report.stages = {.read_us = read_us,
                   .detect_us = microseconds(detected - start),
                   .map_us = microseconds(mapped - detected),
                   .total_us = microseconds(SteadyClock::now() - start)};
}

void CameraPipeline::check_size(const vision::Frame& frame) const {
  if (frame.image.cols == width_px_ && frame.image.rows == height_px_) return;
  throw vision::InputError(
      {setup_.camera, 0, 0},
      fmt::format("frame {} has {}x{} pixels, those before had {}x{}", frame.number,
                  frame.image.cols, frame.image.rows, width_px_, height_px_),
      "let a camera deliver frames of one size");
}

void CameraPipeline::identify(vision::CaptureTime capture_time, FrameReport& report) {
  list_candidates();
  const std::span<const TrackDecision> decisions = tracks_.update(capture_time, candidates_);
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    if (decisions[i].verdict == TrackDecision::Verdict::kReport) {
      report_robot(i, decisions[i].id, capture_time, report);
      continue;
    }
    const std::size_t discs = discs_.robots().size();
    const vision::PixelPoint& centre_px = i < discs
                                              ? discs_.robots()[i].observation->discs[0].centre_px
                                              : tags_->robots()[i - discs].pose.centre_px;
    const bool duplicate = decisions[i].verdict == TrackDecision::Verdict::kDuplicate;
    report.rejected.push_back(
        {centre_px, duplicate ? vision::reject_reason_text(vision::RejectReason::kDuplicateIdentity)
                              : "its number is not certain yet"});
  }
}

void CameraPipeline::list_candidates() {
  candidates_.clear();
  for (const DiscRobot& robot : discs_.robots()) {
    candidates_.push_back(track_candidate(robot, setup_.layouts[robot.layout_index],
                                          first_kind_[robot.layout_index]));
  }
  if (!tags_) return;
  for (const TagRobot& robot : tags_->robots()) {
    candidates_.push_back(track_candidate(robot, first_kind_[robot.layout_index]));
  }
}

void CameraPipeline::report_robot(std::size_t candidate, int id, vision::CaptureTime capture_time,
                                  FrameReport& report) {
  const std::size_t discs = discs_.robots().size();
  if (candidate < discs) {
    const DiscRobot& robot = discs_.robots()[candidate];
    report.robots.push_back(robot_report(robot, id, setup_.layouts[robot.layout_index]));
    discs_.remember(robot, id, capture_time);
    return;
  }
  const TagRobot& robot = tags_->robots()[candidate - discs];
  report.robots.push_back(
      robot_report(robot, id, setup_.layouts[robot.layout_index].teams.front().name));
}

}  // namespace nadir::tracker
