#pragma once

#include "control_client/differential/tracking_controller.h"
#include "control_client/drive/steering.h"

namespace nadir::control_client {

/// The decentralised optimal controller at whatever speed the motion has, forwards, backwards or
/// turning in place: gains are those of the present speed, and what the error to the side does
/// changes its sign with the direction.
class UnicycleSteering : public Steering {
 public:
  /// `weights.heading` > 0: with it the heading is held at rest too.
  UnicycleSteering(const TrackingWeights& weights, const UnicycleLimits& limits)
      : weights_(weights), limits_(limits) {}

  /// v is 0. The motion's own sideways rate is left out.
  Eigen::Vector3d body_rates(const fusion::PlanarPose& estimate, const NominalMotion& motion,
                             double dt_s) override;

 private:
  TrackingWeights weights_;
  UnicycleLimits limits_;
};

}  // namespace nadir::control_client
