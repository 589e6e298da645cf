#include "tracker/wire/pose_codec.h"

#include <algorithm>
#include <cmath>

#include "tracker/wire/codec_parts.h"

namespace nadir::tracker {
namespace {

static_assert(sizeof(nadir_wire_RobotPose::team) == kMaxTeamLength + 1);
static_assert(sizeof(nadir_wire_FrameRobot::team) == kMaxTeamLength + 1);
static_assert(sizeof(nadir_wire_RobotPose::camera) == kMaxCameraLength + 1);
static_assert(sizeof(nadir_wire_FrameSummary::camera) == kMaxCameraLength + 1);

bool is_sound(const nadir_wire_Estimate& estimate) {
  const double pose[3] = {estimate.x_m, estimate.y_m, estimate.heading_rad};
  return is_sound_pose(pose) && is_sound_covariance(estimate.covariance) &&
         std::isfinite(estimate.u_px) && std::isfinite(estimate.v_px) &&
         estimate.confidence >= 0.0 && estimate.confidence <= 1.0 &&
         estimate.pixels._length <= kMaxWireMarkers;
}

bool encode_estimate(const WireRobot& robot, nadir_wire_Estimate* estimate) {
  if (robot.marker_count > kMaxWireMarkers) return false;
  estimate->x_m = robot.pose_world_robot.x_m;
  estimate->y_m = robot.pose_world_robot.y_m;
  estimate->heading_rad = robot.pose_world_robot.heading_rad;
  encode_covariance(robot.covariance, estimate->covariance);
  estimate->u_px = robot.u_px;
  estimate->v_px = robot.v_px;
  estimate->confidence = robot.confidence;
  estimate->pixels._maximum = kMaxWireMarkers;
  estimate->pixels._length = static_cast<std::uint32_t>(robot.marker_count);
  // Writing only reads the sample, but its type has no const.
  estimate->pixels._buffer = const_cast<std::uint32_t*>(robot.pixels.data());
  estimate->pixels._release = false;
  return is_sound(*estimate);
}

bool decode_estimate(const nadir_wire_Estimate& estimate, WireRobot* robot) {
  if (!is_sound(estimate)) return false;
  robot->pose_world_robot = {estimate.x_m, estimate.y_m, estimate.heading_rad};
  decode_covariance(estimate.covariance, &robot->covariance);
  robot->u_px = estimate.u_px;
  robot->v_px = estimate.v_px;
  robot->confidence = estimate.confidence;
  robot->marker_count = estimate.pixels._length;
  robot->pixels.fill(0);
  std::copy_n(estimate.pixels._buffer, robot->marker_count, robot->pixels.begin());
  return true;
}

}  // namespace

bool encode(const WirePose& pose, nadir_wire_RobotPose* sample) {
  sample->robot = pose.robot.robot;
  sample->epoch = pose.epoch;
  sample->frame = pose.frame;
  sample->capture_ns = pose.capture_ns;
  return encode_text(pose.robot.team, sample->team) && encode_text(pose.camera, sample->camera) &&
         encode_estimate(pose.robot, &sample->estimate);
}

bool encode(const WireFrame& frame, std::vector<nadir_wire_FrameRobot>* storage,
            nadir_wire_FrameSummary* sample) {
  if (frame.robots.size() > kMaxRobotsInFrame) return false;
  sample->epoch = frame.epoch;
  sample->frame = frame.frame;
  sample->capture_ns = frame.capture_ns;
  sample->read_us = frame.stages.read_us;
  sample->detect_us = frame.stages.detect_us;
  sample->map_us = frame.stages.map_us;
  sample->total_us = frame.stages.total_us;
  sample->rejected = frame.rejected;
  storage->resize(frame.robots.size());
  for (std::size_t i = 0; i < frame.robots.size(); ++i) {
    nadir_wire_FrameRobot& robot = (*storage)[i];
    robot.robot = frame.robots[i].robot;
    if (!encode_text(frame.robots[i].team, robot.team)) return false;
    if (!encode_estimate(frame.robots[i], &robot.estimate)) return false;
  }
  sample->robots._maximum = static_cast<std::uint32_t>(storage->size());
  sample->robots._length = static_cast<std::uint32_t>(storage->size());
  sample->robots._buffer = storage->data();
  sample->robots._release = false;
  return encode_text(frame.camera, sample->camera);
}

bool decode(const nadir_wire_RobotPose& sample, WirePose* pose) {
  pose->robot.team = sample.team;
  pose->robot.robot = sample.robot;
  pose->camera = sample.camera;
  pose->epoch = sample.epoch;
  pose->frame = sample.frame;
  pose->capture_ns = sample.capture_ns;
  pose->publish_ns = sample.publish_ns;
  return decode_estimate(sample.estimate, &pose->robot);
}

bool decode(const nadir_wire_FrameSummary& sample, WireFrame* frame) {
  if (sample.robots._length > kMaxRobotsInFrame) return false;
  frame->camera = sample.camera;
  frame->epoch = sample.epoch;
  frame->frame = sample.frame;
  frame->capture_ns = sample.capture_ns;
  frame->publish_ns = sample.publish_ns;
  frame->stages = {sample.read_us, sample.detect_us, sample.map_us, sample.total_us};
  frame->rejected = sample.rejected;
  frame->robots.resize(sample.robots._length);
  for (std::size_t i = 0; i < frame->robots.size(); ++i) {
    const nadir_wire_FrameRobot& robot = sample.robots._buffer[i];
    frame->robots[i].team = robot.team;
    frame->robots[i].robot = robot.robot;
    if (!decode_estimate(robot.estimate, &frame->robots[i])) return false;
  }
  return true;
}

}  // namespace nadir::tracker
