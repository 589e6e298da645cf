#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <vector>

#include "tracker/pose_report.h"

namespace nadir::tracker {

/// A robot (or a plate with a robot's marks) that stands at a surveyed place and is not moved.
struct Landmark {
  std::string camera;  ///< that sees it
  std::string team;    ///< as the layout names it
  int id = -1;         ///< of a layout with identities; -1: the nearest of the team is meant
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< on the field
};

/// Watches landmarks and says so when a camera was knocked: then they seem to move, all at once,
/// while they stand. Compares the mean place of the last frames with the surveyed one; what was
/// published as the pose's covariance, which holds the calibration's own error, says how much is
/// normal. Not thread-safe.
class LandmarkMonitor {
 public:
  static constexpr std::size_t kFrames = 20;  ///< that are averaged
  static constexpr double kSearch_m = 0.25;  ///< around the place; further away it is another robot
  static constexpr double kNormalSigmas = 4.0;
  static constexpr double kNormal_m = 0.002;         ///< of survey and model, never a warning
  static constexpr std::size_t kUnseenFrames = 300;  ///< without it, then it counts as lost

  explicit LandmarkMonitor(std::vector<Landmark> landmarks);

  /// Takes one camera's frame. One line for each landmark whose state changed: displaced, back at
  /// its place, not seen any more. Empty nearly always.
  std::vector<std::string> update(const FrameReport& report);

 private:
  enum class State { kUnknown, kInPlace, kDisplaced, kUnseen };
  struct Watch {
    Landmark landmark;
    std::deque<Eigen::Vector2d> offsets_m;  ///< seen minus surveyed, of the last frames
    std::deque<double> variances_m2;        ///< per axis, as published
    std::size_t unseen_frames = 0;
    State state = State::kUnknown;
  };

  static const RobotReport* find(const Landmark& landmark, const FrameReport& report);
  static void judge(Watch& watch, std::vector<std::string>& lines);

  std::vector<Watch> watches_;
};

}  // namespace nadir::tracker
