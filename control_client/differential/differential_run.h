#pragma once

#include <cstdint>
#include <vector>

#include "control_client/differential/inertial_sensors.h"
#include "control_client/differential/tracking_controller.h"
#include "fusion/heading_filter.h"

namespace nadir::control_client {

/// Where the robot takes its heading from. Its place is always counted from its wheels along that
/// heading, as in S1.
enum class HeadingFrom {
  kTruth,
  kWheels,  ///< odometry alone
  kFilter,  ///< gyro and magnetometer
};

/// Somebody turns the robot by hand.
struct Kick {
  double turn_rad = 0.0;  ///< 0: nobody does
  double begin_s = 10.0;
  double duration_s = 0.2;
  bool gyro_feels_it = true;  ///< the wheels never do
};

/// Iron comes near the magnetometer.
struct MagneticEvent {
  Eigen::Vector2d disturbance_world{Eigen::Vector2d::Zero()};  ///< shares of the earth's field
  double begin_s = 20.0;
  double duration_s = 10.0;
};

/// Headings that a camera sees, late; none by default.
struct VisionHeadings {
  double period_s = 0.0;  ///< 0: no camera
  double delay_s = 0.08;
  double deviation_rad = 0.01745;
};

struct DifferentialScenario {
  TrajectoryPtr path;
  TrackingController::Settings controller = DecentralisedSettings{};
  UnicycleLimits limits;
  double track_m = 0.3;  ///< distance of the wheels
  double period_s = 0.02;
  HeadingFrom heading_from = HeadingFrom::kFilter;
  fusion::HeadingFilterSettings filter;
  double magnetometer_variance_rad2 = 0.01;
  double field_tolerance = 0.0;  ///< share of the field's strength that may be wrong; 0: no gate
  InertialErrors errors;
  Kick kick;
  MagneticEvent iron;
  VisionHeadings vision;
};

/// One tick, before the robot moves.
struct DifferentialTick {
  double time_s = 0.0;
  UnicycleReference reference;
  fusion::PlanarPose truth;
  fusion::PlanarPose estimate;
  UnicycleMotion command;
};

/// A run in simulated time from the path's start, at rest; a seed is a run, on every machine.
std::vector<DifferentialTick> run_differential(const DifferentialScenario& scenario,
                                               std::uint64_t seed);

}  // namespace nadir::control_client
