#include "fusion/fuse/fuse_score.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace nadir::fusion {

TruthLine::TruthLine(std::vector<TruthRow> rows) : rows_(std::move(rows)) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < rows_.size(); ++i) steps_s.push_back(rows_[i].t_s - rows_[i - 1].t_s);
  if (steps_s.empty()) return;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  longest_gap_s_ = std::max(longest_gap_s_, 3.0 * *middle);
}

std::optional<PlanarPose> TruthLine::at(double t_s) const {
  const auto after = std::lower_bound(rows_.begin(), rows_.end(), t_s,
                                      [](const TruthRow& row, double t) { return row.t_s < t; });
  if (after == rows_.end()) return std::nullopt;
  if (after->t_s == t_s) return after->pose;
  if (after == rows_.begin()) return std::nullopt;
  const TruthRow& before = *(after - 1);
  const double step_s = after->t_s - before.t_s;
  if (step_s > longest_gap_s_) return std::nullopt;
  const Eigen::Vector3d way =
      (t_s - before.t_s) / step_s * pose_difference(after->pose, before.pose);
  return PlanarPose{before.pose.x_m + way.x(), before.pose.y_m + way.y(),
                    wrap_angle(before.pose.heading_rad + way.z())};
}

FuseScore score(const std::vector<EstimateRow>& estimates, const TruthLine& truth) {
  FuseScore score;
  double squares_m2 = 0.0;
  double squares_rad2 = 0.0;
  double nees_sum = 0.0;
  for (const EstimateRow& row : estimates) {
    if (!row.estimate) continue;
    const auto pose = truth.at(row.t_s);
    if (!pose) continue;
    const Eigen::Vector3d error = pose_difference(row.estimate->pose, *pose);
    ++score.compared;
    squares_m2 += error.head<2>().squaredNorm();
    squares_rad2 += error.z() * error.z();
    score.position_max_m = std::max(score.position_max_m, error.head<2>().norm());
    nees_sum += error.dot(row.estimate->covariance.ldlt().solve(error));
  }
  if (score.compared == 0) return score;
  const auto count = static_cast<double>(score.compared);
  score.position_rms_m = std::sqrt(squares_m2 / count);
  score.heading_rms_rad = std::sqrt(squares_rad2 / count);
  score.nees = nees_sum / count;
  return score;
}

VisionCounts count_vision(const FusionHealth& health) {
  VisionCounts counts;
  counts.accepted = health.count(PoseVerdict::kStarted) + health.count(PoseVerdict::kAccepted);
  counts.recovered = health.count(PoseVerdict::kRecovered) + health.count(PoseVerdict::kReset);
  for (const std::uint64_t count : health.poses) counts.rejected += count;
  counts.rejected -= counts.accepted + counts.recovered;
  return counts;
}

double mean_nis(const std::vector<VisionDecision>& decisions) {
  double sum = 0.0;
  int count = 0;
  for (const VisionDecision& decision : decisions) {
    if (decision.correction.verdict != PoseVerdict::kAccepted) continue;
    sum += decision.correction.nis;
    ++count;
  }
  return count == 0 ? 0.0 : sum / count;
}

}  // namespace nadir::fusion
