#include "tests/support/test_poses.h"

#include <random>

namespace nadir::test {
namespace {

using tracker::WireFrame;
using tracker::WirePose;
using tracker::WireRobot;

constexpr std::int64_t kFirstCapture = 1'700'000'000'000'000'000;  // ns since the Unix epoch
constexpr std::int64_t kFramePeriod = 10'000'000;                  // ns

WireRobot test_robot(std::uint64_t frame, std::int32_t robot) {
  std::minstd_rand random(
      static_cast<unsigned>(1000 * frame + static_cast<std::uint64_t>(robot) + 1));
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  WireRobot result;
  result.team = robot % 2 == 0 ? "blue" : "yellow";
  result.robot = robot;
  result.pose_world_robot = {uniform(-4.5, 4.5), uniform(-3.0, 3.0), uniform(-3.14, 3.14)};
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = uniform(-2e-3, 2e-3);
  result.covariance = root * root.transpose();
  result.u_px = uniform(0.0, 1280.0);
  result.v_px = uniform(0.0, 1024.0);
  result.confidence = uniform(0.0, 1.0);
  result.marker_count = 2 + static_cast<std::size_t>(robot) % 4;
  for (std::size_t i = 0; i < result.marker_count; ++i) {
    result.pixels[i] = static_cast<std::uint32_t>(uniform(5.0, 200.0));
  }
  return result;
}

template <typename Stamped>
std::string stamp_difference(const Stamped& a, const Stamped& b) {
  std::string names;
  if (a.camera != b.camera) names += " camera";
  if (a.epoch != b.epoch) names += " epoch";
  if (a.frame != b.frame) names += " frame";
  if (a.capture_ns != b.capture_ns) names += " capture_ns";
  return names;
}

}  // namespace

WirePose test_pose(std::uint64_t epoch, std::uint64_t frame, std::int32_t robot,
                   const std::string& camera) {
  WirePose pose;
  pose.robot = test_robot(frame, robot);
  pose.camera = camera;
  pose.epoch = epoch;
  pose.frame = frame;
  pose.capture_ns = kFirstCapture + static_cast<std::int64_t>(frame) * kFramePeriod;
  return pose;
}

WireFrame test_frame(std::uint64_t epoch, std::uint64_t frame, std::int32_t robots,
                     const std::string& camera) {
  WireFrame result;
  result.camera = camera;
  result.epoch = epoch;
  result.frame = frame;
  result.capture_ns = kFirstCapture + static_cast<std::int64_t>(frame) * kFramePeriod;
  const double step_us = static_cast<double>(frame % 7);
  result.stages = {1.5 + step_us, 200.25 + step_us, 30.125 + step_us, 240.0 + step_us};
  result.rejected = static_cast<std::uint32_t>(frame % 5);
  for (std::int32_t robot = 0; robot < robots; ++robot) {
    result.robots.push_back(test_robot(frame, robot));
  }
  return result;
}

std::string difference(const WireRobot& a, const WireRobot& b) {
  std::string names;
  if (a.team != b.team) names += " team";
  if (a.robot != b.robot) names += " robot";
  if (a.pose_world_robot.x_m != b.pose_world_robot.x_m) names += " x_m";
  if (a.pose_world_robot.y_m != b.pose_world_robot.y_m) names += " y_m";
  if (a.pose_world_robot.heading_rad != b.pose_world_robot.heading_rad) names += " heading_rad";
  if (a.covariance != b.covariance) names += " covariance";
  if (a.u_px != b.u_px) names += " u_px";
  if (a.v_px != b.v_px) names += " v_px";
  if (a.confidence != b.confidence) names += " confidence";
  if (a.marker_count != b.marker_count) names += " marker_count";
  if (a.pixels != b.pixels) names += " pixels";
  return names;
}

std::string difference(const WirePose& a, const WirePose& b) {
  return stamp_difference(a, b) + difference(a.robot, b.robot);
}

std::string difference(const WireFrame& a, const WireFrame& b) {
  std::string names = stamp_difference(a, b);
  if (a.stages.read_us != b.stages.read_us) names += " read_us";
  if (a.stages.detect_us != b.stages.detect_us) names += " detect_us";
  if (a.stages.map_us != b.stages.map_us) names += " map_us";
  if (a.stages.total_us != b.stages.total_us) names += " total_us";
  if (a.rejected != b.rejected) names += " rejected";
  if (a.robots.size() != b.robots.size()) return names + " robots";
  for (std::size_t i = 0; i < a.robots.size(); ++i) names += difference(a.robots[i], b.robots[i]);
  return names;
}

}  // namespace nadir::test
