#pragma once

#include <Eigen/Core>

#include "control_client/simulation/random_stream.h"

namespace nadir::control_client {

/// Errors of S1's sensors, as theory section 9 (E8) states them.
struct InertialErrors {
  double gyro_radps = 0.02;        ///< white, of each sample
  double bias_walk_radps = 0.002;  ///< random walk of the gyro's bias, in the root of a second
  double field_share = 0.1;        ///< of the magnetometer's horizontal axes: 0.1 rad of heading
};

/// A gyro that turns with the robot: counter-clockwise, rad/s.
class SimulatedGyro {
 public:
  SimulatedGyro(const InertialErrors& errors, std::uint64_t run_seed)
      : errors_(errors), random_(run_seed, RandomPurpose::kGyro) {}

  /// What it says of a period of `dt_s` in which the robot turned at a mean rate.
  double sample(double turn_rate_radps, double dt_s);

 private:
  InertialErrors errors_;
  RandomStream random_;
  double bias_radps_ = 0.0;
};

/// The earth's field and what else is near, in shares of the earth's horizontal field.
struct MagneticField {
  double down = 1.5;                                           ///< inclination of 56 degrees
  Eigen::Vector2d disturbance_world{Eigen::Vector2d::Zero()};  ///< by iron; north is x
};

/// A magnetometer on a level robot; axes as fusion/magnetic_heading.h wants them.
class SimulatedMagnetometer {
 public:
  SimulatedMagnetometer(const InertialErrors& errors, std::uint64_t run_seed)
      : errors_(errors), random_(run_seed, RandomPurpose::kMagnetometer) {}

  Eigen::Vector3d sample(double heading_rad, const MagneticField& field);

 private:
  InertialErrors errors_;
  RandomStream random_;
};

}  // namespace nadir::control_client
