#pragma once

#include <Eigen/Core>

#include "control_client/rover/rover_model.h"
#include "control_client/rover/velocity_controller.h"
#include "control_client/rover/velocity_source.h"
#include "fusion/body_rates.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

struct RoverFirmwareSettings {
  double step_s = 0.005;
  double observer_radps = 40.0;  ///< bandwidth of the disturbance observer
  double velocity_radps = 20.0;  ///< of the velocity, once the disturbances are compensated
};

/// The inner loop of a rover with encoders: body rates in, wheel forces out. S4's observer and
/// compensation on the way that the encoders report, in the frame in which that way began; no
/// integrator, as the observer finds constant forces.
class RoverFirmware {
 public:
  RoverFirmware(const RoverModel& model, const RoverFirmwareSettings& settings);

  /// The motors were off: nothing is known of velocity and disturbances.
  void restart();

  /// The mean rates that the encoders report of the last step, and those that are wanted; the wheel
  /// forces (N) of the next step.
  Eigen::Vector3d wheel_forces_n(const fusion::BodyRates& measured,
                                 const fusion::BodyRates& wanted);

 private:
  RoverModel model_;
  RoverFirmwareSettings settings_;
  VelocitySource velocity_;
  VelocityController controller_;
  fusion::PlanarPose pose_;  // where the encoders lead
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::control_client
