#include "control_client/rover/rover_metrics.h"

#include <algorithm>
#include <cmath>

namespace nadir::control_client {
namespace {

void add_errors(RoverSummary& sum, const RoverRecord& record) {
  double mae_xy_m = 0.0;
  double mae_heading_rad = 0.0;
  double deviation_rad = 0.0;
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (const RoverTick& tick : record.ticks) {
    const Eigen::Vector3d error = fusion::pose_difference(tick.estimate, tick.truth).cwiseAbs();
    sum.iae_xy_m += error.x() + error.y();
    sum.iae_heading_rad += error.z();
    mae_xy_m = std::max(mae_xy_m, error.x() + error.y());
    mae_heading_rad = std::max(mae_heading_rad, error.z());
    deviation_rad = std::max(deviation_rad, std::abs(tick.truth.heading_rad));
    squares += Eigen::Vector2d(error.head<2>().squaredNorm(), error.z() * error.z());
  }
  squares /= static_cast<double>(record.ticks.size());
  sum.mae_xy_m += mae_xy_m;
  sum.mae_heading_rad += mae_heading_rad;
  sum.heading_deviation_rad += deviation_rad;
  sum.position_rms_m += squares[0];
  sum.heading_rms_rad += squares[1];
  sum.nis += record.nis;
}

double landmark_mean_square_m2(const RoverWorld& world, const RoverRecord& record) {
  double sum = 0.0;
  for (std::size_t i = 0; i < world.landmarks_m.size(); ++i) {
    sum += (record.map_m[i] - world.landmarks_m[i]).squaredNorm();
  }
  return sum / static_cast<double>(world.landmarks_m.size());
}

/// At the first tick the pose is known, and its NEES says nothing.
void add_nees(RoverSummary& sum, const std::vector<const RoverRecord*>& records) {
  if (records.empty()) return;
  const auto [low, high] = nees_band(static_cast<int>(records.size()));
  const std::size_t ticks = records.front()->ticks.size();
  for (std::size_t k = 1; k < ticks; ++k) {
    double mean = 0.0;
    for (const RoverRecord* record : records) mean += record->ticks[k].nees;
    mean /= static_cast<double>(records.size());
    sum.nees += mean / static_cast<double>(ticks - 1);
    if (mean > low && mean < high) sum.nees_in_band += 1.0 / static_cast<double>(ticks - 1);
  }
}

}  // namespace

std::pair<double, double> nees_band(int runs) {
  const double degrees = 3.0 * runs;
  const double a = 2.0 / (9.0 * degrees);
  const auto quantile = [&](double normal) {
    const double root = 1.0 - a + normal * std::sqrt(a);
    return 3.0 * root * root * root;
  };
  return {quantile(-1.959963984540054), quantile(1.959963984540054)};
}

RoverSummary summarize(const RoverWorld& world, const std::vector<RoverRecord>& records) {
  RoverSummary sum;
  sum.runs = static_cast<int>(records.size());
  std::vector<const RoverRecord*> good;
  for (const RoverRecord& record : records) {
    if (record.diverged_s >= 0.0) {
      ++sum.diverged;
      sum.diverged_s += record.diverged_s;
      continue;
    }
    good.push_back(&record);
    add_errors(sum, record);
    sum.landmark_rms_m += landmark_mean_square_m2(world, record);
    if (record.tour_done_s < 0.0) continue;
    ++sum.tours_done;
    sum.tour_done_s += record.tour_done_s;
  }
  add_nees(sum, good);
  if (sum.diverged > 0) sum.diverged_s /= sum.diverged;
  if (sum.tours_done > 0) sum.tour_done_s /= sum.tours_done;
  if (good.empty()) return sum;
  const auto n = static_cast<double>(good.size());
  for (double* mean : {&sum.iae_xy_m, &sum.mae_xy_m, &sum.iae_heading_rad, &sum.mae_heading_rad,
                       &sum.position_rms_m, &sum.heading_rms_rad, &sum.heading_deviation_rad,
                       &sum.landmark_rms_m, &sum.nis}) {
    *mean /= n;
  }
  for (double* square : {&sum.position_rms_m, &sum.heading_rms_rad, &sum.landmark_rms_m}) {
    *square = std::sqrt(*square);
  }
  return sum;
}

}  // namespace nadir::control_client
