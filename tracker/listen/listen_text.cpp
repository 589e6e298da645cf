#include "tracker/listen/listen_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace nadir::tracker {
namespace {

using Json = nlohmann::ordered_json;

double age_ms(std::int64_t capture_ns, std::int64_t now_ns) {
  return static_cast<double>(now_ns - capture_ns) * 1e-6;
}

/// Names come from the network: what is not UTF-8 is replaced, not an error.
std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json covariance_json(const fusion::PoseCovariance& covariance) {
  Json numbers = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) numbers.push_back(covariance(row, column));
  }
  return numbers;
}

Json pose_numbers(const fusion::PlanarPose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"heading_rad", pose.heading_rad}};
}

Json robot_json(const WireRobot& robot) {
  Json pixels = Json::array();
  for (std::size_t i = 0; i < robot.marker_count; ++i) pixels.push_back(robot.pixels[i]);
  return {{"id", robot.robot},
          {"team", robot.team},
          {"x_m", robot.pose_world_robot.x_m},
          {"y_m", robot.pose_world_robot.y_m},
          {"heading_rad", robot.pose_world_robot.heading_rad},
          {"covariance", covariance_json(robot.covariance)},
          {"u_px", robot.u_px},
          {"v_px", robot.v_px},
          {"pixels", pixels},
          {"confidence", robot.confidence}};
}

}  // namespace

std::string pose_columns_header() {
  return fmt::format("{:<8} {:<8} {:>4} {:>8} {:>8} | {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} | {}",
                     "camera", "team", "id", "frame", "age_ms", "x_m", "y_m", "head_rad", "sd_x_m",
                     "sd_y_m", "sd_h_rad", "cov xx xy xh yy yh hh");
}

std::string pose_columns(const WirePose& pose, std::int64_t now_ns) {
  const WireRobot& robot = pose.robot;
  const fusion::PoseCovariance& cov = robot.covariance;
  return fmt::format(
      "{:<8} {:<8} {:>4} {:>8} {:>8.2f} | {:>8.4f} {:>8.4f} {:>8.4f} | {:>8.5f} {:>8.5f} {:>8.5f} "
      "| "
      "{:.3e} {:.3e} {:.3e} {:.3e} {:.3e} {:.3e}",
      pose.camera, robot.team, robot.robot, pose.frame, age_ms(pose.capture_ns, now_ns),
      robot.pose_world_robot.x_m, robot.pose_world_robot.y_m, robot.pose_world_robot.heading_rad,
      std::sqrt(cov(0, 0)), std::sqrt(cov(1, 1)), std::sqrt(cov(2, 2)), cov(0, 0), cov(0, 1),
      cov(0, 2), cov(1, 1), cov(1, 2), cov(2, 2));
}

std::string pose_json(const WirePose& pose, std::int64_t now_ns) {
  Json json = robot_json(pose.robot);
  json["camera"] = pose.camera;
  json["epoch"] = pose.epoch;
  json["frame"] = pose.frame;
  json["capture_ns"] = pose.capture_ns;
  json["publish_ns"] = pose.publish_ns;
  json["receive_ns"] = now_ns;
  json["age_ms"] = age_ms(pose.capture_ns, now_ns);
  return one_line(json);
}

std::string frame_columns_header() {
  return fmt::format("{:<8} {:>8} {:>8} | {:>6} {:>8} | {:>9} {:>9} {:>9} {:>9}", "camera", "frame",
                     "age_ms", "robots", "rejected", "read_us", "detect_us", "map_us", "total_us");
}

std::string frame_columns(const WireFrame& frame, std::int64_t now_ns) {
  const WireStageTimes& stages = frame.stages;
  return fmt::format("{:<8} {:>8} {:>8.2f} | {:>6} {:>8} | {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f}",
                     frame.camera, frame.frame, age_ms(frame.capture_ns, now_ns),
                     frame.robots.size(), frame.rejected, stages.read_us, stages.detect_us,
                     stages.map_us, stages.total_us);
}

std::string frame_json(const WireFrame& frame, std::int64_t now_ns) {
  Json robots = Json::array();
  for (const WireRobot& robot : frame.robots) robots.push_back(robot_json(robot));
  const Json json = {{"frame", frame.frame},
                     {"camera", frame.camera},
                     {"epoch", frame.epoch},
                     {"capture_ns", frame.capture_ns},
                     {"publish_ns", frame.publish_ns},
                     {"age_ms", age_ms(frame.capture_ns, now_ns)},
                     {"stages_us",
                      {{"read", frame.stages.read_us},
                       {"detect", frame.stages.detect_us},
                       {"map", frame.stages.map_us},
                       {"total", frame.stages.total_us}}},
                     {"robots", robots},
                     {"rejected", frame.rejected}};
  return one_line(json);
}

std::string client_columns_header() {
  return fmt::format(
      "{:<8} {:>4} {:<10} {:<15} | {:>8} {:>8} {:>8} | {:>8} {:>8} {:>9} | {:>7} {:>6} {:>5} {:>5} "
      "{:>5} | {:>8} {:>7} {:>9} {:>8} | {}",
      "team", "id", "mode", "reason", "x_m", "y_m", "head_rad", "ahead_mm", "left_mm", "head_mrad",
      "pose_ms", "accept", "rejec", "late", "lost", "ticks", "missed", "clock_ms", "sigma_ms",
      "text");
}

std::string client_columns(const WireClientState& state, std::int64_t /*now_ns*/) {
  const fusion::PlanarPose& pose = state.estimate_world_robot;
  const WireClientCounts& counts = state.counts;
  return fmt::format(
      "{:<8} {:>4} {:<10} {:<15} | {:>8.4f} {:>8.4f} {:>8.4f} | {:>8.2f} {:>8.2f} {:>9.2f} | "
      "{:>7.1f} {:>6} {:>5} {:>5} {:>5} | {:>8} {:>7} {:>9.3f} {:>8.3f} | {}",
      state.team, state.robot, name_of(state.mode), name_of(state.reason), pose.x_m, pose.y_m,
      pose.heading_rad, 1e3 * state.error_ahead_m, 1e3 * state.error_left_m,
      1e3 * state.error_heading_rad, 1e-6 * static_cast<double>(state.pose_age_ns),
      counts.poses_accepted, counts.poses_rejected, counts.poses_late, counts.poses_lost,
      counts.ticks, counts.ticks_missed, 1e-6 * static_cast<double>(state.clock_offset_ns),
      1e-6 * static_cast<double>(state.clock_sigma_ns), state.text);
}

std::string client_json(const WireClientState& state, std::int64_t now_ns) {
  const WireClientCounts& counts = state.counts;
  const Json json = {{"id", state.robot},
                     {"team", state.team},
                     {"epoch", state.epoch},
                     {"sequence", state.sequence},
                     {"stamp_ns", state.stamp_ns},
                     {"age_ms", age_ms(state.stamp_ns, now_ns)},
                     {"mode", name_of(state.mode)},
                     {"reason", name_of(state.reason)},
                     {"text", state.text},
                     {"estimate", pose_numbers(state.estimate_world_robot)},
                     {"covariance", covariance_json(state.covariance)},
                     {"nominal", pose_numbers(state.nominal_world_robot)},
                     {"error_ahead_m", state.error_ahead_m},
                     {"error_left_m", state.error_left_m},
                     {"error_heading_rad", state.error_heading_rad},
                     {"pose_age_ns", state.pose_age_ns},
                     {"poses",
                      {{"accepted", counts.poses_accepted},
                       {"rejected", counts.poses_rejected},
                       {"late", counts.poses_late},
                       {"lost", counts.poses_lost}}},
                     {"recoveries", counts.recoveries},
                     {"odometry_samples", counts.odometry_samples},
                     {"ticks", counts.ticks},
                     {"ticks_missed", counts.ticks_missed},
                     {"clock_offset_ns", state.clock_offset_ns},
                     {"clock_sigma_ns", state.clock_sigma_ns}};
  return one_line(json);
}

}  // namespace nadir::tracker
