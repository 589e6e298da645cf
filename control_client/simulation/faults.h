#pragma once

#include <Eigen/Core>
#include <optional>

#include "control_client/simulation/plant.h"

namespace nadir::control_client {

/// The camera's cable pulls the robot back once it is taut (the regions A and B of S0 IV.A): a
/// force, and a creep of the wheels over the floor that no encoder sees.
struct CableDrag {
  Eigen::Vector2d anchor_m = {-1.0, 0.0};
  double free_length_m = 1.1;
  double acceleration_per_s2 = 2.0;  ///< m/s^2 for each metre beyond the free length
  double creep_per_s = 0.1;          ///< m/s for each metre beyond the free length

  Disturbance at(const Eigen::Vector2d& position_m) const;
};

/// Somebody carries the robot to another place.
struct Kidnapping {
  double at_s = 0.0;
  Eigen::Vector3d by = Eigen::Vector3d::Zero();  ///< x m, y m, heading rad
};

/// A motor that gets no voltage from some time on.
struct WheelFailure {
  double at_s = 0.0;
  int wheel = 0;  ///< from 0
};

/// What goes wrong in a run besides the camera (VisionParameters).
struct Faults {
  std::optional<CableDrag> cable;
  std::optional<Kidnapping> kidnapping;
  std::optional<WheelFailure> wheel_failure;
};

}  // namespace nadir::control_client
