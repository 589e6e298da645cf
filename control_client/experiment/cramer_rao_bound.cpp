#include "control_client/experiment/cramer_rao_bound.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fusion/odometry.h"

namespace nadir::control_client {
namespace {

using fusion::PoseCovariance;

struct Step {
  Eigen::Matrix3d transition;  ///< A
  Eigen::Matrix3d noise;       ///< W Q W^T
};

std::vector<Step> steps_along_truth(const RunRecord& record,
                                    const Eigen::Matrix3d& rate_covariance) {
  std::vector<Step> steps;
  double heading_rad = record.start.z();
  for (const TickRecord& tick : record.ticks) {
    const fusion::Motion motion = fusion::constant_rate_motion(
        heading_rad, fusion::BodyRates::from(tick.true_mean_rates), record.tick_s);
    steps.push_back(
        {motion.by_pose(), motion.by_rates * rate_covariance * motion.by_rates.transpose()});
    heading_rad = tick.truth.z();
  }
  return steps;
}

/// Frames with information, by the tick of their capture (from 0: the end of tick 1).
struct Information {
  std::vector<Eigen::Vector3d> precision;  ///< inverse variances; zero without a frame
  std::vector<std::size_t> arrival;        ///< index of the tick
};

Information frame_information(const RunRecord& record) {
  Information information{
      std::vector<Eigen::Vector3d>(record.ticks.size(), Eigen::Vector3d::Zero()),
      std::vector<std::size_t>(record.ticks.size(), 0)};
  for (const VisionFrame& frame : record.frames) {
    if (frame.is_lost || frame.is_outlier) continue;
    const auto index = static_cast<std::size_t>(frame.capture_tick) - 1;
    information.precision[index] = frame.variances.cwiseInverse();
    information.arrival[index] = static_cast<std::size_t>(frame.arrival_tick) - 1;
  }
  return information;
}

PoseCovariance predicted(const PoseCovariance& covariance, const Step& step) {
  return step.transition * covariance * step.transition.transpose() + step.noise;
}

PoseCovariance corrected(const PoseCovariance& covariance, const Eigen::Vector3d& precision) {
  if (precision.isZero(0.0)) return covariance;
  Eigen::Matrix3d information = covariance.inverse();
  information.diagonal() += precision;
  return information.inverse();
}

std::vector<PoseCovariance> delayed_bound(const std::vector<Step>& steps, Information information,
                                          const PoseCovariance& start) {
  // known[i]: after tick i with all frames that have arrived. A frame that arrives changes known
  // from its capture on.
  std::vector<PoseCovariance> known(steps.size());
  std::vector<PoseCovariance> bound;
  std::vector<bool> is_used(steps.size(), false);
  for (std::size_t now = 0; now < steps.size(); ++now) {
    std::size_t from = now;
    const std::size_t oldest = now > 100 ? now - 100 : 0;
    for (std::size_t i = oldest; i <= now; ++i) {
      if (is_used[i] || information.precision[i].isZero(0.0) || information.arrival[i] > now)
        continue;
      is_used[i] = true;
      from = std::min(from, i);
    }
    for (std::size_t i = from; i <= now; ++i) {
      known[i] = predicted(i == 0 ? start : known[i - 1], steps[i]);
      if (is_used[i]) known[i] = corrected(known[i], information.precision[i]);
    }
    bound.push_back(known[now]);
  }
  return bound;
}

}  // namespace

std::vector<PoseCovariance> cramer_rao_bound(const RunRecord& record,
                                             const Eigen::Matrix3d& rate_covariance,
                                             const PoseCovariance& start, BoundKind kind) {
  const std::vector<Step> steps = steps_along_truth(record, rate_covariance);
  const Information information = frame_information(record);
  if (kind == BoundKind::kDelayed) return delayed_bound(steps, information, start);

  std::vector<PoseCovariance> before;
  std::vector<PoseCovariance> bound;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    before.push_back(predicted(i == 0 ? start : bound[i - 1], steps[i]));
    bound.push_back(corrected(before[i], information.precision[i]));
  }
  if (kind == BoundKind::kZeroDelay) return bound;
  // Rauch, Tung and Striebel, backwards: P += G (P_next - P-_next) G^T, G = P A^T (P-_next)^-1.
  for (std::size_t i = steps.size() - 1; i-- > 0;) {
    const Eigen::Matrix3d gain =
        bound[i] * steps[i + 1].transition.transpose() * before[i + 1].inverse();
    bound[i] += gain * (bound[i + 1] - before[i + 1]) * gain.transpose();
  }
  return bound;
}

PoseErrors bound_errors(const RunRecord& record, const std::vector<PoseCovariance>& bound,
                        double from_s) {
  PoseErrors errors;
  double position_m2 = 0.0;
  double heading_rad2 = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    if (record.ticks[i].time_s <= from_s + 1e-9) continue;
    position_m2 += bound[i](0, 0) + bound[i](1, 1);
    heading_rad2 += bound[i](2, 2);
    ++count;
  }
  if (count == 0) return errors;
  errors.position_rms_m = std::sqrt(position_m2 / count);
  errors.heading_rms_rad = std::sqrt(heading_rad2 / count);
  return errors;
}

}  // namespace nadir::control_client
