#pragma once

#include <Eigen/Core>

namespace nadir::control_client {

/// S4's omnidirectional rover: three wheels 120 degrees apart, driven by forces.
struct RoverParameters {
  double mass_kg = 1.5;
  double inertia_kgm2 = 0.025;
  double arm_m = 0.10;  ///< from the centre to each wheel
};

/// From wheel forces to forces on the body and back (theory 6): M p'' = Bw(heading) u + d with
/// p = (x, y, heading) in the world frame and
///
///     Bw = 1/2 [ -2c  c + sqrt3 s  c - sqrt3 s ; -2s  s - sqrt3 c  s + sqrt3 c ; 2L  2L  2L ]
///
/// Its rows are orthogonal, with squares 3/2, 3/2, 3 L^2, so Bw^-1 = Bw^T diag(2/3, 2/3, 1/(3
/// L^2)).
class RoverModel {
 public:
  RoverModel() = default;
  explicit RoverModel(const RoverParameters& parameters) : parameters_(parameters) {}

  const RoverParameters& parameters() const { return parameters_; }
  /// Diagonal of M: kg, kg, kg m^2.
  Eigen::Vector3d inertia() const {
    return {parameters_.mass_kg, parameters_.mass_kg, parameters_.inertia_kgm2};
  }
  /// Bw at a heading.
  Eigen::Matrix3d wheel_matrix(double heading_rad) const;
  /// The wheel forces (N) that push with `force` (world frame: N, N, N m).
  Eigen::Vector3d wheel_forces(double heading_rad, const Eigen::Vector3d& force) const;

 private:
  RoverParameters parameters_;
};

}  // namespace nadir::control_client
