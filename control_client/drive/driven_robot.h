#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "control_client/drive/robot_base.h"
#include "control_client/drive/simulated_base.h"
#include "control_client/drive/steering.h"
#include "control_client/robot_file.h"
#include "control_client/trajectory.h"

namespace nadir::control_client {

/// What `nadir-client drive` has to know of a robot. All that is left out is as for an
/// omnidirectional one.
struct DrivenRobot {
  RobotConfig config;                             ///< limits and controller
  std::optional<fusion::WheelGeometry> geometry;  ///< other wheels than config's
  bool takes_volts = true;                        ///< false: its firmware closes the inner loop
  bool moves_sideways = true;                     ///< false: it turns first, then drives
  std::shared_ptr<Steering> steering;             ///< null: the outer loop
  /// A trajectory, called `name`, as this robot can drive it; null: as it is. Throws
  /// vision::InputError if it cannot.
  std::function<TrajectoryPtr(const std::string& name, TrajectoryPtr)> suited;
  /// The simulated robot, from `now` on.
  std::function<std::unique_ptr<RobotBase>(const SimulationSettings&, fusion::Timestamp now,
                                           SimulatedBase::TruthSink)>
      simulated;
};

}  // namespace nadir::control_client
