#include "fusion/magnetic_heading.h"

#include <cmath>

#include "fusion/planar_pose.h"

namespace nadir::fusion {

Eigen::Vector2d level_field(const Eigen::Vector3d& field_body, const Tilt& tilt) {
  const double sin_a = std::sin(tilt.roll_rad);
  const double cos_a = std::cos(tilt.roll_rad);
  const double sin_b = std::sin(tilt.pitch_rad);
  const double cos_b = std::cos(tilt.pitch_rad);
  const double side = field_body.y() * sin_a + field_body.z() * cos_a;
  return {field_body.x() * cos_b + side * sin_b, field_body.y() * cos_a - field_body.z() * sin_a};
}

double magnetic_heading_rad(const Eigen::Vector3d& field_body, const Tilt& tilt) {
  const Eigen::Vector2d level = level_field(field_body, tilt);
  return wrap_angle(std::atan2(level.y(), level.x()));
}

bool FieldGate::passes(const Eigen::Vector3d& field_body) const {
  const double measured = field_body.norm();
  if (!std::isfinite(measured)) return false;
  return strength == 0.0 || std::abs(measured - strength) <= tolerance * strength;
}

}  // namespace nadir::fusion
