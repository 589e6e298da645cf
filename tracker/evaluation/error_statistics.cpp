#include "tracker/evaluation/error_statistics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace nadir::tracker {
namespace {

/// 95 % quantile of chi-square with 3 degrees of freedom.
constexpr double kChiSquare3Quantile95 = 7.814728;
/// 97.5 % quantile of the normal distribution.
constexpr double kNormalQuantile975 = 1.959964;

void add_nees(const PoseError& error, ErrorStatistics& sum) {
  const Eigen::LLT<Eigen::Matrix3d> cholesky(error.covariance);
  if (cholesky.info() != Eigen::Success) {
    ++sum.singular;
    return;
  }
  const double nees = error.pose.dot(cholesky.solve(error.pose));
  sum.mean_nees += nees;
  if (nees <= kChiSquare3Quantile95) sum.coverage95 += 1.0;
}

}  // namespace

ErrorStatistics summarise(const std::vector<PoseError>& errors) {
  ErrorStatistics sum;
  sum.count = errors.size();
  if (errors.empty()) return sum;

  std::vector<double> distances_m;
  std::vector<double> headings_rad;
  for (const PoseError& error : errors) {
    sum.rms += error.pose.cwiseAbs2();
    sum.bias += error.pose;
    sum.rms_px += error.pixel.cwiseAbs2();
    sum.bias_px += error.pixel;
    distances_m.push_back(error.pose.head<2>().norm());
    headings_rad.push_back(std::abs(error.pose.z()));
    add_nees(error, sum);
  }
  const double count = static_cast<double>(errors.size());
  sum.rms = (sum.rms / count).cwiseSqrt().eval();
  sum.bias /= count;
  sum.rms_px = (sum.rms_px / count).cwiseSqrt().eval();
  sum.bias_px /= count;
  sum.rms_position_m = sum.rms.head<2>().norm();
  sum.p95_position_m = percentile(std::move(distances_m), 0.95);
  sum.p95_heading_rad = percentile(std::move(headings_rad), 0.95);
  if (const double regular = count - static_cast<double>(sum.singular); regular > 0.0) {
    sum.mean_nees /= regular;
    sum.coverage95 /= regular;
  }
  return sum;
}

Band nees_band95(std::size_t count) {
  if (count == 0) return {};
  const double freedom = 3.0 * static_cast<double>(count);
  // chi2_q(k) ~ k (1 - 2 / 9k + z_q sqrt(2 / 9k))^3
  const auto mean_at = [&](double z) {
    const double root = 1.0 - 2.0 / (9.0 * freedom) + z * std::sqrt(2.0 / (9.0 * freedom));
    return freedom * root * root * root / static_cast<double>(count);
  };
  return {mean_at(-kNormalQuantile975), mean_at(kNormalQuantile975)};
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

}  // namespace nadir::tracker
