#include "tracker/publisher.h"

#include <algorithm>
#include <span>

namespace nadir::tracker {
namespace {

static_assert(kMaxWireMarkers >= static_cast<std::size_t>(vision::kMaxDiscs));

void fill_robot(const RobotReport& report, WireRobot* robot) {
  robot->team = report.team;
  robot->robot = report.id;
  robot->pose_world_robot = report.pose_world_robot;
  robot->covariance = report.covariance;
  robot->u_px = report.centre_px.x();
  robot->v_px = report.centre_px.y();
  robot->confidence = report.confidence;
  robot->marker_count = static_cast<std::size_t>(report.marker_count);
  for (std::size_t i = 0; i < robot->marker_count; ++i) {
    robot->pixels[i] = static_cast<std::uint32_t>(std::max(0, report.pixels[i]));
  }
}

}  // namespace

void fill_pose(const FrameReport& report, const RobotReport& robot, std::uint64_t epoch,
               WirePose* pose) {
  fill_robot(robot, &pose->robot);
  pose->camera = report.camera;
  pose->epoch = epoch;
  pose->frame = report.frame;
  pose->capture_ns = report.capture_ns;
}

void fill_frame(const FrameReport& report, std::uint64_t epoch, WireFrame* frame) {
  frame->camera = report.camera;
  frame->epoch = epoch;
  frame->frame = report.frame;
  frame->capture_ns = report.capture_ns;
  frame->stages = {report.stages.read_us, report.stages.detect_us, report.stages.map_us,
                   report.stages.total_us};
  frame->rejected = static_cast<std::uint32_t>(static_cast<std::int64_t>(report.rejected.size()) +
                                               report.rejected_not_listed);
  // Monitors see no more than a sample holds; every robot gets its own pose all the same.
  frame->robots.resize(std::min(report.robots.size(), kMaxRobotsInFrame));
  for (std::size_t i = 0; i < frame->robots.size(); ++i)
    fill_robot(report.robots[i], &frame->robots[i]);
}

Publisher::Publisher(const Participant& participant, std::uint64_t epoch)
    : epoch_(epoch), writer_(participant) {}

void Publisher::publish(const FrameReport& report) {
  const std::lock_guard lock(mutex_);
  if (poses_.size() < report.robots.size()) poses_.resize(report.robots.size());
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    fill_pose(report, report.robots[i], epoch_, &poses_[i]);
  }
  writer_.publish(std::span(poses_.data(), report.robots.size()));
  fill_frame(report, epoch_, &frame_);
  writer_.publish(frame_);
}

PoseWriter::Status Publisher::status() const {
  const std::lock_guard lock(mutex_);
  return writer_.status();
}

}  // namespace nadir::tracker
