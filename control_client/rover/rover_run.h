#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "control_client/rover/rover_navigator.h"
#include "control_client/rover/rover_plant.h"

namespace nadir::control_client {

/// S4's field, as far as its slides tell (theory 6; places chosen), and a sensor of landmarks.
struct RoverWorld {
  std::vector<Eigen::Vector2d> landmarks_m{{2.0, 1.5}, {5.0, 2.5}, {8.0, 1.0}, {8.5, 5.0},
                                           {9.0, 8.5}, {5.5, 7.5}, {2.0, 8.5}, {1.0, 5.0}};
  std::vector<Eigen::Vector2d> way_points_m{
      {3.0, 3.0}, {7.0, 3.0}, {7.0, 7.0}, {3.0, 7.0}, {1.0, 1.0}};
  fusion::PlanarPose start{1.0, 1.0, 0.0};
  DriveLosses losses;
  double sensor_range_m = 10.0;
  double range_error_m = 0.05;                       ///< uniform between plus and minus this
  double bearing_error_rad = 0.0017453292519943296;  ///< 0.1 degree
  double duration_s = 60.0;
  /// The first look is before it drives. Otherwise it is a tick later, and the map has the error of
  /// that tick's prediction from then on.
  bool looks_first = true;
};

/// One tick of a run, after what was seen is used.
struct RoverTick {
  double time_s = 0.0;
  fusion::PlanarPose truth;
  fusion::PlanarPose estimate;
  double nees = 0.0;  ///< of the pose, expectation 3
};

struct RoverRecord {
  std::vector<RoverTick> ticks;
  std::vector<Eigen::Vector2d> map_m;  ///< at the end, as the landmarks of the world
  double nis = 0.0;                    ///< mean of the sightings; expectation 2
  double tour_done_s = -1.0;           ///< below 0: never
  double diverged_s = -1.0;  ///< when it ended early, more than 1 m off; below 0: it did not
};

/// A run in simulated time; a seed is a run, on every machine.
RoverRecord run_rover(const RoverWorld& world, const NavigatorSettings& settings,
                      std::uint64_t seed);

}  // namespace nadir::control_client
