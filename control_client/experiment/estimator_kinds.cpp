#include "control_client/experiment/estimator_kinds.h"

#include <stdexcept>

#include "control_client/experiment/fusion_estimator.h"
#include "fusion/odometry_noise.h"

namespace nadir::control_client {

std::string estimator_name(EstimatorKind kind) {
  switch (kind) {
    case EstimatorKind::kTruth:
      return "truth";
    case EstimatorKind::kEncoders:
      return "encoders alone";
    case EstimatorKind::kVision:
      return "vision alone";
    case EstimatorKind::kFusion:
      return "fusion";
    case EstimatorKind::kEkf:
      return "fusion, EKF";
    case EstimatorKind::kFusionNoGate:
      return "fusion, no gate";
    case EstimatorKind::kFusionNoReplay:
      return "fusion, no replay";
    case EstimatorKind::kFusionNoRecovery:
      return "fusion, no recovery";
    case EstimatorKind::kRaceEkf:
      return "EKF of the race";
    case EstimatorKind::kRaceEkfOneNoise:
      return "the same, one R";
  }
  throw std::invalid_argument("no such estimator");
}

namespace {

std::unique_ptr<Estimator> race_ekf(bool with_one_noise) {
  using Ekf = fusion::DelayedFusion<fusion::AboutEstimate, fusion::AccelerationOdometryNoise>;
  Ekf::Settings settings;
  settings.filter.gate = fusion::Gate::none();
  auto ekf = std::make_unique<FusionEstimator<Ekf>>(settings);
  constexpr double kMiddle_px = 25.0;
  if (with_one_noise) ekf->assume_variances(pose_variances(kMiddle_px, kMiddle_px));
  return ekf;
}

}  // namespace

std::unique_ptr<Estimator> make_estimator(EstimatorKind kind, const fusion::WheelGeometry& geometry,
                                          double rim_sigma_mps, double tick_s) {
  using Nominal = FusionEstimator<NominalFusion>;
  auto settings = paper_settings<NominalFusion>(geometry, rim_sigma_mps, tick_s);
  switch (kind) {
    case EstimatorKind::kTruth:
      return std::make_unique<TruthEstimator>();
    case EstimatorKind::kEncoders:
      return std::make_unique<DeadReckoning>();
    case EstimatorKind::kVision:
      return std::make_unique<HeldVision>();
    case EstimatorKind::kFusion:
      return std::make_unique<Nominal>(settings);
    case EstimatorKind::kEkf:
      return std::make_unique<FusionEstimator<EkfFusion>>(
          paper_settings<EkfFusion>(geometry, rim_sigma_mps, tick_s));
    case EstimatorKind::kFusionNoGate:
      settings.filter.gate = fusion::Gate::none();
      return std::make_unique<Nominal>(settings);
    case EstimatorKind::kFusionNoReplay:
      return std::make_unique<Nominal>(settings, LateFrames::kTakenAsNew);
    case EstimatorKind::kFusionNoRecovery:
      settings.filter.recovery.poses = 0;
      return std::make_unique<Nominal>(settings);
    case EstimatorKind::kRaceEkf:
    case EstimatorKind::kRaceEkfOneNoise:
      return race_ekf(kind == EstimatorKind::kRaceEkfOneNoise);
  }
  throw std::invalid_argument("no such estimator");
}

}  // namespace nadir::control_client
