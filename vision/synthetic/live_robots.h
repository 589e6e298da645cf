#pragma once

#include <string>
#include <vector>

#include "vision/frame.h"
#include "vision/synthetic/robot_path.h"

namespace nadir::vision {

/// A robot that somebody else moves, such as a simulation in another process.
struct LiveRobot {
  std::string team;  ///< name of one of the layout's teams
  int id = 0;        ///< one of the layout's identities; any number if it is anonymous
  RobotMotion motion;
};

/// Who knows where live robots are. The synthetic camera asks at each frame; how the answer comes
/// to be (a network, a test) is no business of vision's.
class LiveRobots {
 public:
  LiveRobots() = default;
  LiveRobots(const LiveRobots&) = delete;
  LiveRobots& operator=(const LiveRobots&) = delete;
  virtual ~LiveRobots() = default;

  /// Fills `robots` with those that are on the field at a time, where they were then.
  virtual void at(CaptureTime time, std::vector<LiveRobot>& robots) = 0;
  /// Told of a robot that the scene has no team or identity for: it is not shown.
  virtual void cannot_show(const LiveRobot& robot) { static_cast<void>(robot); }
};

}  // namespace nadir::vision
