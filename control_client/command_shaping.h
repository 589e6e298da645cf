#pragma once

#include <Eigen/Core>

#include "control_client/nominal_motion.h"
#include "control_client/pseudo_differentiator.h"
#include "control_client/robot_model.h"

namespace nadir::control_client {

/// Schedule of the bandwidth: our own, for S2 5.2 does not print one.
struct ShapingParameters {
  double damping = 0.7;
  double max_bandwidth_radps = 8.0;
  double min_bandwidth_radps = 0.5;
  double grid_ratio = 0.93;       ///< of neighbours on the grid of tried bandwidths
  double voltage_share = 0.7;     ///< of the motors' range that the nominal motion may use
  double time_constant_s = 0.05;  ///< with which the bandwidth follows its target
  double max_rise_radps2 = 20.0;  ///< of the bandwidth
  double step_s = 0.001;          ///< of the integration
};

/// Command filter whose bandwidth falls where the motors could not follow (time-varying bandwidth
/// command shaping, S2 5.2). Each tick takes, on a geometric grid, the largest bandwidth whose
/// nominal motion stays within its share of the motors' voltage; the filter's own bandwidth follows
/// it. One bandwidth for all three channels keeps straight paths straight.
class CommandShaping {
 public:
  /// `model` outlives the filter. It starts at rest at `start`, with the bandwidth that suits
  /// `first_command`.
  CommandShaping(const RobotModel& model, const ShapingParameters& parameters,
                 const Eigen::Vector3d& start, const Eigen::Vector3d& first_command);

  /// `command` (x m, y m, unwrapped heading rad) acts for dt_s, a multiple of the inner step.
  void step(const Eigen::Vector3d& command, double dt_s);

  NominalMotion motion() const { return {filter_.value(), filter_.rate_per_s()}; }
  double bandwidth_radps() const { return filter_.bandwidth_radps(); }
  /// Largest bandwidth that the motors allow for this command now.
  double target_bandwidth_radps(const Eigen::Vector3d& command) const;

 private:
  double nominal_voltage_v(const Eigen::Vector3d& command, double bandwidth_radps) const;

  const RobotModel* model_;
  ShapingParameters parameters_;
  VaryingPseudoDifferentiator filter_;
};

}  // namespace nadir::control_client
