#include "tracker/landmark_monitor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nadir::tracker {
namespace {

std::string name(const Landmark& landmark) {
  return landmark.id < 0 ? landmark.team : fmt::format("{} {}", landmark.team, landmark.id);
}

template <typename Value>
Value mean(const std::deque<Value>& values, Value start) {
  return std::accumulate(values.begin(), values.end(), std::move(start),
                         [](const Value& a, const Value& b) { return Value(a + b); }) /
         static_cast<double>(values.size());
}

}  // namespace

LandmarkMonitor::LandmarkMonitor(std::vector<Landmark> landmarks) {
  for (Landmark& landmark : landmarks) watches_.push_back({.landmark = std::move(landmark)});
}

const RobotReport* LandmarkMonitor::find(const Landmark& landmark, const FrameReport& report) {
  const RobotReport* found = nullptr;
  double nearest_m = kSearch_m;
  for (const RobotReport& robot : report.robots) {
    if (robot.team != landmark.team) continue;
    if (landmark.id >= 0 && robot.id != landmark.id) continue;
    const double distance_m = (robot.pose_world_robot.position_m() - landmark.place_m).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    found = &robot;
  }
  return found;
}

std::vector<std::string> LandmarkMonitor::update(const FrameReport& report) {
  std::vector<std::string> lines;
  for (Watch& watch : watches_) {
    if (watch.landmark.camera != report.camera) continue;
    const RobotReport* robot = find(watch.landmark, report);
    if (robot == nullptr) {
      if (++watch.unseen_frames == kUnseenFrames) {
        watch.state = State::kUnseen;
        watch.offsets_m.clear();
        watch.variances_m2.clear();
        lines.push_back(fmt::format(
            "{}: landmark {} is not seen within {:g} m of its place: is it hidden, taken away, or "
            "was the camera turned?",
            report.camera, name(watch.landmark), kSearch_m));
      }
      continue;
    }
    watch.unseen_frames = 0;
    watch.offsets_m.push_back(robot->pose_world_robot.position_m() - watch.landmark.place_m);
    watch.variances_m2.push_back(robot->covariance.topLeftCorner<2, 2>().trace() / 2.0);
    if (watch.offsets_m.size() > kFrames) {
      watch.offsets_m.pop_front();
      watch.variances_m2.pop_front();
    }
    if (watch.offsets_m.size() == kFrames) judge(watch, lines);
  }
  return lines;
}

void LandmarkMonitor::judge(Watch& watch, std::vector<std::string>& lines) {
  const Eigen::Vector2d offset_m = mean<Eigen::Vector2d>(watch.offsets_m, Eigen::Vector2d::Zero());
  const double sigma_m = std::sqrt(mean(watch.variances_m2, 0.0));
  const double normal_m = kNormal_m + kNormalSigmas * sigma_m;
  // A little less brings it back than took it away, so that it does not flicker.
  const double limit_m = watch.state == State::kDisplaced ? 0.8 * normal_m : normal_m;
  const State before = watch.state;
  watch.state = offset_m.norm() > limit_m ? State::kDisplaced : State::kInPlace;
  if (watch.state == before) return;
  if (watch.state == State::kDisplaced) {
    lines.push_back(fmt::format(
        "{}: landmark {} seems to have moved by {:+.1f} mm in x, {:+.1f} mm in y ({:.1f} mm are "
        "normal): was the camera knocked? Calibrate again, or see nadir-calibrate compare",
        watch.landmark.camera, name(watch.landmark), 1e3 * offset_m.x(), 1e3 * offset_m.y(),
        1e3 * normal_m));
  } else if (before != State::kUnknown) {
    lines.push_back(fmt::format("{}: landmark {} is at its place again", watch.landmark.camera,
                                name(watch.landmark)));
  }
}

}  // namespace nadir::tracker
