#pragma once

#include <memory>
#include <string>

#include "control_client/experiment/estimator.h"
#include "fusion/wheel_geometry.h"

namespace nadir::control_client {

/// The estimators that experiments compare.
enum class EstimatorKind {
  kTruth,             ///< the true pose
  kEncoders,          ///< odometry alone
  kVision,            ///< the newest frame, held, as late as it came
  kFusion,            ///< the papers' filter along the nominal trajectory, all of it
  kEkf,               ///< the same about the estimate
  kFusionNoGate,      ///< every frame is believed
  kFusionNoReplay,    ///< late frames are taken as if they were of now
  kFusionNoRecovery,  ///< a locked-out gate stays locked
  kRaceEkf,           ///< S3's: EKF, odometry noise that knows the acceleration
  kRaceEkfOneNoise,   ///< the same with one variance for all frames, that of 20 to 30 pixels
};

/// For tables, as in "fusion, no gate".
std::string estimator_name(EstimatorKind kind);

/// `rim_sigma_mps`: the filters' idea of the wheels' white noise in one tick.
std::unique_ptr<Estimator> make_estimator(EstimatorKind kind, const fusion::WheelGeometry& geometry,
                                          double rim_sigma_mps, double tick_s);

}  // namespace nadir::control_client
