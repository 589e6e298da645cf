#include "control_client/experiment/run_metrics.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace nadir::control_client {
namespace {

/// Collects errors in x, y, heading.
class ErrorSum {
 public:
  void add(const Eigen::Vector3d& error) {
    const double heading_rad = fusion::wrap_angle(error.z());
    squares_m2_ += error.head<2>().squaredNorm();
    squares_rad2_ += heading_rad * heading_rad;
    max_m_ = std::max(max_m_, error.head<2>().norm());
    ++count_;
  }
  PoseErrors result() const {
    if (count_ == 0) return {};
    return {std::sqrt(squares_m2_ / count_), std::sqrt(squares_rad2_ / count_), max_m_};
  }

 private:
  double squares_m2_ = 0.0;
  double squares_rad2_ = 0.0;
  double max_m_ = 0.0;
  int count_ = 0;
};

double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double length2 = way.squaredNorm();
  const double share =
      length2 > 0.0 ? std::clamp((point - from).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (point - from - share * way).norm();
}

double path_rms_m(const RunRecord& record, std::size_t first) {
  // Every fourth tick is enough: neighbours are much the same.
  constexpr std::size_t kStride = 4;
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = first; i < record.ticks.size(); i += kStride, ++count) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 1; j < record.ticks.size(); ++j) {
      nearest = std::min(nearest, distance_to_segment(record.ticks[i].truth.head<2>(),
                                                      record.ticks[j - 1].command.head<2>(),
                                                      record.ticks[j].command.head<2>()));
    }
    sum += nearest * nearest;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

Eigen::Vector3d pose_vector(const fusion::PlanarPose& pose) {
  return {pose.x_m, pose.y_m, pose.heading_rad};
}

void count_frames(const RunRecord& record, std::size_t estimator, EstimateMetrics& metrics) {
  double nis_sum = 0.0;
  int nis_count = 0;
  for (const FrameDecision& decision : record.decisions[estimator]) {
    const VisionFrame& frame = record.frames[decision.number];
    const Eigen::Vector3d truth =
        record.ticks[static_cast<std::size_t>(frame.capture_tick) - 1].truth;
    const double off_m = (pose_vector(frame.pose_world_robot) - truth).head<2>().norm();
    metrics.accepted += decision.is_used ? 1 : 0;
    if (decision.is_used && !decision.is_recovered) {
      nis_sum += decision.nis;
      ++nis_count;
    }
    if (!frame.is_outlier) {
      ++metrics.inliers;
      metrics.inliers_rejected += decision.is_used ? 0 : 1;
    } else if (off_m > kOutlier_m) {
      ++metrics.outliers;
      metrics.outliers_accepted += decision.is_used ? 1 : 0;
    }
  }
  metrics.nis = nis_count > 0 ? nis_sum / nis_count : 0.0;
}

EstimateMetrics measure_estimate(const RunRecord& record, std::size_t estimator,
                                 std::size_t first) {
  EstimateMetrics metrics;
  ErrorSum errors;
  double nees_sum = 0.0;
  int nees_count = 0;
  for (std::size_t i = first; i < record.ticks.size(); ++i) {
    const EstimateRecord& estimate = record.estimates[estimator][i];
    Eigen::Vector3d error = pose_vector(estimate.pose) - record.ticks[i].truth;
    error.z() = fusion::wrap_angle(error.z());
    errors.add(error);
    if (!estimate.covariance) continue;
    nees_sum += error.dot(estimate.covariance->inverse() * error);
    ++nees_count;
  }
  metrics.error = errors.result();
  if (nees_count > 0) metrics.nees = nees_sum / nees_count;
  count_frames(record, estimator, metrics);
  return metrics;
}

void add_squares(PoseErrors& sum, const PoseErrors& errors) {
  sum.position_rms_m += errors.position_rms_m * errors.position_rms_m;
  sum.heading_rms_rad += errors.heading_rms_rad * errors.heading_rms_rad;
  sum.position_max_m = std::max(sum.position_max_m, errors.position_max_m);
}

void take_roots(PoseErrors& sum, double count) {
  sum.position_rms_m = std::sqrt(sum.position_rms_m / count);
  sum.heading_rms_rad = std::sqrt(sum.heading_rms_rad / count);
}

void add(EstimateMetrics& sum, const EstimateMetrics& run) {
  add_squares(sum.error, run.error);
  sum.nees += run.nees;
  sum.nis += run.nis;
  sum.accepted += run.accepted;
  sum.outliers += run.outliers;
  sum.outliers_accepted += run.outliers_accepted;
  sum.inliers += run.inliers;
  sum.inliers_rejected += run.inliers_rejected;
}

// How a step is answered; of all ticks.
void measure_step(const RunRecord& record, RunMetrics& metrics) {
  constexpr double kSettled_m = 0.02;
  constexpr double kSettled_rad = 2.0 * 3.14159265358979323846 / 180.0;
  for (const TickRecord& tick : record.ticks) {
    const Eigen::Vector3d off = tick.truth - tick.command;
    if (off.head<2>().norm() > kSettled_m || std::abs(off.z()) > kSettled_rad) {
      metrics.settled_s = tick.time_s;
    }
    metrics.overshoot_x_m =
        std::max(metrics.overshoot_x_m, tick.truth.x() - record.ticks.back().command.x());
    metrics.to_nominal_max_m =
        std::max(metrics.to_nominal_max_m, (tick.truth - tick.nominal.pose).head<2>().norm());
    metrics.saturated += tick.is_saturated ? 1.0 / static_cast<double>(record.ticks.size()) : 0.0;
    metrics.peak_demand_v = std::max(metrics.peak_demand_v, tick.demanded_voltage_v);
  }
}

}  // namespace

RunMetrics measure(const RunRecord& record, double from_s) {
  RunMetrics metrics;
  metrics.has_diverged = record.has_diverged;
  const auto first_tick =
      std::find_if(record.ticks.begin(), record.ticks.end(),
                   [&](const TickRecord& t) { return t.time_s > from_s + 1e-9; });
  const auto first = static_cast<std::size_t>(first_tick - record.ticks.begin());
  ErrorSum nominal;
  ErrorSum command;
  for (std::size_t i = first; i < record.ticks.size(); ++i) {
    nominal.add(record.ticks[i].truth - record.ticks[i].nominal.pose);
    command.add(record.ticks[i].truth - record.ticks[i].command);
  }
  metrics.to_nominal = nominal.result();
  metrics.to_command = command.result();
  metrics.path_rms_m = path_rms_m(record, first);
  measure_step(record, metrics);
  for (std::size_t i = 0; i < record.estimates.size(); ++i) {
    metrics.estimates.push_back(measure_estimate(record, i, first));
  }
  return metrics;
}

Summary summarize(const std::vector<RunMetrics>& runs) {
  Summary summary;
  summary.runs = runs.size();
  if (runs.empty()) return summary;
  const auto count = static_cast<double>(runs.size());
  RunMetrics& mean = summary.mean;
  mean.estimates.resize(runs.front().estimates.size());
  for (const RunMetrics& run : runs) {
    summary.diverged += run.has_diverged ? 1 : 0;
    add_squares(mean.to_nominal, run.to_nominal);
    add_squares(mean.to_command, run.to_command);
    mean.path_rms_m += run.path_rms_m * run.path_rms_m;
    mean.saturated += run.saturated / count;
    mean.peak_demand_v = std::max(mean.peak_demand_v, run.peak_demand_v);
    mean.overshoot_x_m = std::max(mean.overshoot_x_m, run.overshoot_x_m);
    mean.settled_s = std::max(mean.settled_s, run.settled_s);
    mean.to_nominal_max_m = std::max(mean.to_nominal_max_m, run.to_nominal_max_m);
    for (std::size_t i = 0; i < mean.estimates.size(); ++i)
      add(mean.estimates[i], run.estimates[i]);
  }
  take_roots(mean.to_nominal, count);
  take_roots(mean.to_command, count);
  mean.path_rms_m = std::sqrt(mean.path_rms_m / count);
  for (EstimateMetrics& estimate : mean.estimates) {
    take_roots(estimate.error, count);
    estimate.nees /= count;
    estimate.nis /= count;
  }
  mean.has_diverged = summary.diverged > 0;
  return summary;
}

}  // namespace nadir::control_client
