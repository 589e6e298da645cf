#pragma once

#include <Eigen/Core>
#include <optional>

#include "fusion/body_rates.h"
#include "fusion/correction.h"
#include "fusion/planar_pose.h"
#include "fusion/timestamp.h"

namespace nadir::fusion {

/// How much older frames are than their capture stamps say; negative where they are younger.
struct TimeOffsetReading {
  double offset_s = 0.0;
  double sigma_s = 0.0;
};

/// Finds the constant latency of vision that nobody declared, from the innovations of the running
/// filter against the nominal velocity (theory 3.2).
///
/// A frame that is tau older than its stamp shows z = p(t) - p'(t) tau. The filter follows the
/// frames, so the innovation is not -p' tau but what is left of it after earlier frames pulled the
/// estimate along; its derivative by tau is carried along with the filter's own gains K:
///
///     phi = d e / d tau = -p' - F s,    s+ = F s + K phi,    s = d estimate / d tau
///
/// and tau follows from weighted least squares of e on phi, recursively. Linear in tau: meant for
/// up to a tenth of a second (MotionLag finds more). Only changes of velocity tell anything. The
/// velocity must be the planned one, not the measured: the noise of odometry moves the innovation,
/// too, and would be taken for an answer (MotionLag does without a plan). Sigma
/// is the larger of the filter's own and of how the answers of spans of time scatter, as errors of
/// odometry are seldom white. Fixed memory.
class TimeOffsetEstimator {
 public:
  struct Settings {
    double memory_s = 600.0;  ///< after so long an innovation counts 1/e
    double span_s = 10.0;     ///< of the answers whose scatter is looked at
    double longest_gap_s = 1.0;
  };

  TimeOffsetEstimator() : TimeOffsetEstimator(Settings{}) {}
  explicit TimeOffsetEstimator(const Settings& settings) : settings_(settings) {}

  /// A pose that the filter used, with what the filter said of it and the planned body rates at its
  /// capture time. Poses that were not used, and poses out of order, are left out.
  void add(Timestamp capture, const PlanarPose& measured, const PoseCovariance& covariance,
           const Correction& correction, const BodyRates& nominal_rates);

  /// Nothing before a span of time with changing velocity has passed.
  std::optional<TimeOffsetReading> reading() const;

 private:
  void restart(const PlanarPose& pose, const Eigen::Vector3d& velocity);
  void close_span();

  Settings settings_;
  bool has_started_ = false;
  Timestamp last_{0};
  PlanarPose pose_;                                      // after the last correction
  Eigen::Vector3d by_offset_ = Eigen::Vector3d::Zero();  // s
  Timestamp span_began_{0};
  double span_information_ = 0.0;  // sum of phi^T S^-1 phi, phi^T S^-1 e within the span
  double span_vector_ = 0.0;
  double information_ = 0.0;  // of closed spans
  double vector_ = 0.0;
  double vector_squared_ = 0.0;  // sums over closed spans, for the scatter
  double product_ = 0.0;
  double information_squared_ = 0.0;
  double spans_ = 0.0;
};

}  // namespace nadir::fusion
