#pragma once

#include <Eigen/Core>

namespace nadir::fusion {

/// How the robot leans, from its accelerometers: x to the front, y to the right, z down.
struct Tilt {
  double roll_rad = 0.0;   ///< about x, alpha of S1
  double pitch_rad = 0.0;  ///< about y, beta of S1
};

/// The horizontal part of a field that a leaning robot measured (any unit; x to the front, y to the
/// right, z down), in the level frame below the robot (S1 eq 22, 23; the sign of mz in the second
/// line is corrected):
///
///     X_H = mx cos b + my sin a sin b + mz cos a sin b
///     Y_H = my cos a - mz sin a
Eigen::Vector2d level_field(const Eigen::Vector3d& field_body, const Tilt& tilt);

/// The robot's heading from magnetic north, counter-clockwise seen from above as all headings of
/// nadir are: atan2(Y_H, X_H), which is the negative of S1's clockwise angle. rad, in (-pi, pi].
double magnetic_heading_rad(const Eigen::Vector3d& field_body, const Tilt& tilt);

/// Whether a measured field can be the earth's: iron and motors change its strength too.
struct FieldGate {
  double strength = 0.0;    ///< of the undisturbed field, unit of the magnetometer; 0: no gate
  double tolerance = 0.15;  ///< share of the strength

  bool passes(const Eigen::Vector3d& field_body) const;
};

}  // namespace nadir::fusion
