#pragma once

#include <Eigen/Core>

#include "fusion/correction.h"
#include "fusion/gap_motion.h"
#include "fusion/gate.h"
#include "fusion/linearization.h"
#include "fusion/measured_pose.h"
#include "fusion/odometry.h"
#include "fusion/odometry_step.h"
#include "fusion/planar_pose.h"
#include "fusion/verdict.h"
#include "fusion/white_odometry_noise.h"

namespace nadir::fusion {

/// Kalman filter of a planar pose, and of the error states of its odometry where the model has
/// some, from mean body rates and measured poses (S0 II.B, S2 section 4, S3; theory 3). A value:
/// its state can be copied, kept and put back.
template <class Linearization = AboutEstimate,
          OdometryErrorModel OdometryError = WhiteOdometryNoise>
class PoseFilter {
 public:
  using Nominal = typename Linearization::Nominal;
  static constexpr int kErrorStates = OdometryError::kStates;
  static constexpr int kStates = 3 + kErrorStates;
  using ErrorState = Eigen::Matrix<double, kErrorStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct Settings {
    Gate gate;
    LockOutRecovery recovery;
    GapMotion gap;
    OdometryError odometry_error;
  };

  struct State {
    bool has_started = false;
    PlanarPose pose;
    ErrorState odometry_error = ErrorState::Zero();
    /// Order x, y, heading, error states.
    Covariance covariance = Covariance::Zero();
    RejectedRun rejected;

    PoseCovariance pose_covariance() const { return covariance.template topLeftCorner<3, 3>(); }
  };

  PoseFilter() = default;
  explicit PoseFilter(const Settings& settings) : settings_(settings) {}

  const Settings& settings() const { return settings_; }
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

  /// Starts at a pose that is known so well. The covariance is symmetric positive definite.
  void start(const PlanarPose& pose, const PoseCovariance& covariance) {
    state_ = State{};
    set_pose(pose, covariance);
  }

  /// Step 1 of theory 3: moves the pose by the odometry's rates over step.dt_s. Nothing happens
  /// before the start. Returns the transition matrix F of the covariance, P- = F P F^T + noise.
  Covariance predict(const OdometryStep& step, const Nominal& nominal = {});

  /// A time without odometry: the pose becomes uncertain (GapMotion).
  /// Returns F as predict does.
  Covariance predict_gap(const BodyRates& last_rates, double dt_s);

  /// Steps 2 and 3: gate, and correction with the full 3x3 covariance of the measured pose. The
  /// first pose starts the filter.
  Correction correct(const PlanarPose& measured, const PoseCovariance& covariance);

 private:
  void set_pose(const PlanarPose& pose, const PoseCovariance& covariance);
  PoseVerdict judge_rejected(const PlanarPose& measured, const PoseCovariance& covariance,
                             const Eigen::Vector3d& innovation);
  void apply(const Eigen::Vector3d& innovation, const PoseCovariance& covariance);

  Settings settings_;
  State state_;
};

}  // namespace nadir::fusion

#include "fusion/pose_filter_impl.h"
