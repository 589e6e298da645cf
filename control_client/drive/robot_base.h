#pragma once

#include <optional>
#include <vector>

#include "control_client/drive/onboard_fusion.h"
#include "fusion/planar_pose.h"
#include "fusion/timestamp.h"
#include "tracker/wire/robot_io.h"

namespace nadir::control_client {

/// Motors and encoders of the robot, wherever they are.
class RobotBase {
 public:
  virtual ~RobotBase() = default;

  /// What the encoders have reported until `now`, in the order of time, on the robot's clock.
  /// `odometry` is emptied first.
  virtual void take_odometry(fusion::Timestamp now, std::vector<OdometryInterval>* odometry) = 0;
  /// A new command, which holds from `now` on.
  virtual void command(const tracker::WireWheelCommand& command, fusion::Timestamp now) = 0;
  /// Where the robot really is at a time shortly after the odometry that was taken; only simulated
  /// robots know.
  virtual std::optional<fusion::PlanarPose> truth_at(fusion::Timestamp /*time*/) const {
    return std::nullopt;
  }

 protected:
  RobotBase() = default;
  RobotBase(const RobotBase&) = default;
  RobotBase& operator=(const RobotBase&) = default;
};

}  // namespace nadir::control_client
