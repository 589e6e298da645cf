#include "fusion/odometry_noise.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fusion/odometry.h"
#include "fusion/sine_cosine.h"

namespace nadir::fusion {
namespace {

constexpr std::size_t kLeastSamples = 10;

struct Point {
  double acceleration2 = 0.0;  ///< squared, (m/s^2)^2
  double variance = 0.0;       ///< one estimate of it, per second
};

struct Line {
  double k1 = 0.0;
  double k2 = 0.0;
  double sigma_k1 = 0.0;
  double sigma_k2 = 0.0;

  double at(double acceleration2) const { return k1 + k2 * acceleration2; }
};

bool slow(const BodyRates& rates, const AccelerationNoise& noise) {
  return std::hypot(rates.u_mps, rates.v_mps) < noise.standing_mps &&
         std::abs(rates.r_radps) < noise.standing_radps;
}

bool is_usable(const OdometryErrorSample& sample) {
  return sample.interval_s > 0.0 && std::isfinite(sample.interval_s) &&
         std::isfinite(sample.acceleration_mps2) && sample.error.allFinite();
}

/// One weighted round: the weight of a point is 1 / (relative variance v^2), v from the line of
/// the round before. `relative_variance` of one point is 2 / (squares that were averaged in it).
Line weighted_fit(std::span<const Point> points, const Line& before, double smallest,
                  double relative_variance) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Point& point : points) {
    const double v = std::max(before.at(point.acceleration2), smallest);
    const double weight = 1.0 / (relative_variance * v * v);
    const Eigen::Vector2d row(1.0, point.acceleration2);
    normal += weight * row * row.transpose();
    right += weight * point.variance * row;
  }
  const Eigen::Matrix2d covariance = normal.inverse();
  const Eigen::Vector2d k = covariance * right;
  Line line{k[0], k[1], std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1))};
  if (line.k2 < 0.0) {
    line.k2 = 0.0;
    line.k1 = right[0] / normal(0, 0);
  } else if (line.k1 < 0.0) {
    line.k1 = 0.0;
    line.k2 = right[1] / normal(1, 1);
  }
  return line;
}

Line fit(std::span<const Point> points, double relative_variance) {
  double mean = 0.0;
  double mean_acceleration2 = 0.0;
  for (const Point& point : points) {
    mean += point.variance / static_cast<double>(points.size());
    mean_acceleration2 += point.acceleration2 / static_cast<double>(points.size());
  }
  // Without errors there is nothing to weigh by.
  if (mean <= 0.0) return {};
  // Equal weights would leave the start to the few largest errors.
  Line line{0.5 * mean, 0.5 * mean / mean_acceleration2, 0.0, 0.0};
  constexpr int kRounds = 6;
  for (int i = 0; i < kRounds; ++i) {
    line = weighted_fit(points, line, 1e-3 * mean, relative_variance);
  }
  return line;
}

}  // namespace

double linear_acceleration_mps2(const OdometryStep& step) {
  return std::hypot(step.mean_rates.u_mps - step.previous_rates.u_mps,
                    step.mean_rates.v_mps - step.previous_rates.v_mps) /
         step.between_middles_s();
}

CorrectedRates<0> AccelerationOdometryNoise::corrected(
    const OdometryStep& step, const Eigen::Matrix<double, 0, 1>& /*error*/) const {
  CorrectedRates<0> result;
  result.rates = step.mean_rates;
  if (slow(step.mean_rates, noise_) && slow(step.previous_rates, noise_)) return result;
  const double a = linear_acceleration_mps2(step);
  const double along_m2ps = noise_.k1_m2ps + noise_.k2_m2ps * a * a;
  const double turn_rad2ps = noise_.k1_rad2ps + noise_.k2_rad2ps * a * a;
  result.white_intensity = Eigen::Vector3d(along_m2ps, along_m2ps, turn_rad2ps).asDiagonal();
  return result;
}

OdometryErrorSample odometry_error(const OdometryStep& step, const PlanarPose& before,
                                   const PlanarPose& after) {
  const PlanarPose measured = moved(before, step.mean_rates, step.interval_s);
  const Eigen::Vector3d world = pose_difference(measured, after);
  const auto [s, c] = sine_cosine(before.heading_rad);
  OdometryErrorSample sample;
  sample.error = {c * world.x() + s * world.y(), c * world.y() - s * world.x(), world.z()};
  sample.acceleration_mps2 = linear_acceleration_mps2(step);
  sample.interval_s = step.interval_s;
  return sample;
}

std::optional<IdentifiedNoise> identify_acceleration_noise(
    std::span<const OdometryErrorSample> samples) {
  if (samples.size() < kLeastSamples) return std::nullopt;
  std::vector<Point> along;
  std::vector<Point> turn;
  along.reserve(samples.size());
  turn.reserve(samples.size());
  for (const OdometryErrorSample& sample : samples) {
    if (!is_usable(sample)) return std::nullopt;
    const double a2 = sample.acceleration_mps2 * sample.acceleration_mps2;
    along.push_back({a2, sample.error.head<2>().squaredNorm() / (2.0 * sample.interval_s)});
    turn.push_back({a2, sample.error.z() * sample.error.z() / sample.interval_s});
  }
  const auto [least, most] = std::minmax_element(
      along.begin(), along.end(),
      [](const Point& a, const Point& b) { return a.acceleration2 < b.acceleration2; });
  if (most->acceleration2 - least->acceleration2 <= 1e-9 * most->acceleration2) {
    return std::nullopt;
  }
  const Line of_place = fit(along, 1.0);
  const Line of_heading = fit(turn, 2.0);
  IdentifiedNoise result;
  result.noise.k1_m2ps = of_place.k1;
  result.noise.k2_m2ps = of_place.k2;
  result.noise.k1_rad2ps = of_heading.k1;
  result.noise.k2_rad2ps = of_heading.k2;
  result.sigma_k1_m2ps = of_place.sigma_k1;
  result.sigma_k2_m2ps = of_place.sigma_k2;
  result.sigma_k1_rad2ps = of_heading.sigma_k1;
  result.sigma_k2_rad2ps = of_heading.sigma_k2;
  return result;
}

}  // namespace nadir::fusion
