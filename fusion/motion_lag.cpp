#include "fusion/motion_lag.h"

#include <algorithm>
#include <cmath>

namespace nadir::fusion {
namespace {

/// Points of the path are no closer, so that the ring holds two and a half seconds of any odometry.
constexpr std::chrono::nanoseconds kPathStep = std::chrono::milliseconds(5);
/// Twice the logarithm of the likelihood by which the best lag must beat the worst.
constexpr double kClear = 25.0;
constexpr double kFewestPairs = 10.0;
/// Pairs so close in time are left out together by the jackknife.
constexpr std::chrono::nanoseconds kGroupLength = std::chrono::seconds(5);
/// The parabola through the minimum reaches so many candidates to each side.
constexpr int kReach = 3;

}  // namespace

void MotionLag::add_odometry(Timestamp from, Timestamp to, const BodyRates& mean_rates) {
  if (to <= from || !mean_rates.is_finite()) return;
  if (size_ > 0 && from < point(size_ - 1).time) size_ = 0;  // the clock was set
  if (size_ == 0) {
    pair_count_ = 0;
    path_[first_] = {from, Eigen::Array3d::Zero()};
    size_ = 1;
  }
  const PathPoint last = point(size_ - 1);
  // In a gap the rates are taken to have been those after it: its pairs are few.
  const Eigen::Array3d path = last.path + mean_rates.vector().array() * to_seconds(to - last.time);
  if (size_ >= 2 && to - point(size_ - 2).time < kPathStep) {
    path_[(first_ + size_ - 1) % kPathPoints] = {to, path};
  } else {
    if (size_ == kPathPoints) {
      first_ = (first_ + 1) % kPathPoints;
      --size_;
    }
    path_[(first_ + size_) % kPathPoints] = {to, path};
    ++size_;
  }
  while (pair_count_ > 0 && pairs_[first_pair_].to - from_seconds(kFirst_s) <= to) {
    compare(pairs_[first_pair_]);
    first_pair_ = (first_pair_ + 1) % kPairs;
    --pair_count_;
  }
}

void MotionLag::add_pose(Timestamp capture, const PlanarPose& pose) {
  if (anchor_time_ && capture <= *anchor_time_ &&
      to_seconds(*anchor_time_ - capture) < 3.0 * settings_.base_s) {
    return;
  }
  const double elapsed_s = anchor_time_ ? to_seconds(capture - *anchor_time_) : -1.0;
  if (elapsed_s >= 0.0 && elapsed_s < settings_.base_s - 1e-6) return;
  if (elapsed_s > 0.0 && elapsed_s < 3.0 * settings_.base_s && pair_count_ < kPairs) {
    const Eigen::Vector3d moved = pose_difference(pose, anchor_);
    const double heading_rad = anchor_.heading_rad + 0.5 * moved.z();
    const double c = std::cos(heading_rad);
    const double s = std::sin(heading_rad);
    pairs_[(first_pair_ + pair_count_) % kPairs] = {
        *anchor_time_,
        capture,
        {c * moved.x() + s * moved.y(), -s * moved.x() + c * moved.y(), moved.z()}};
    ++pair_count_;
  }
  anchor_time_ = capture;
  anchor_ = pose;
}

std::optional<Eigen::Array3d> MotionLag::path_at(Timestamp time) const {
  if (size_ < 2 || time < point(0).time || time > point(size_ - 1).time) return std::nullopt;
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (point(middle).time <= time ? low : high) = middle;
  }
  const PathPoint& a = point(low);
  const PathPoint& b = point(high);
  const double part = to_seconds(time - a.time) / to_seconds(b.time - a.time);
  return a.path + part * (b.path - a.path);
}

void MotionLag::compare(const Pair& pair) {
  Eigen::Array<double, 3, kCandidates> told;
  for (int i = 0; i < kCandidates; ++i) {
    const Timestamp lag = from_seconds(kFirst_s + i * kStep_s);
    const auto from = path_at(pair.from - lag);
    const auto to = path_at(pair.to - lag);
    if (!from || !to) return;
    told.col(i) = *to - *from;
  }
  const double elapsed_s = std::max(0.0, to_seconds(pair.to - last_compared_));
  const double kept = std::exp(-elapsed_s / settings_.memory_s);
  last_compared_ = pair.to;
  for (Evidence& group : groups_) {
    group.weight *= kept;
    for (Sums& sums : group.axes) sums.scale(kept);
  }
  Evidence& group = groups_.at(static_cast<std::size_t>(pair.to / kGroupLength) % kGroups);
  group.weight += 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double seen = pair.moved[axis];
    const Row row = told.row(axis);
    group.axes.at(static_cast<std::size_t>(axis))
        .add({seen, seen * seen, row, row.square(), seen * row}, 1.0);
  }
}

void MotionLag::Sums::scale(double factor) {
  seen *= factor;
  seen_squared *= factor;
  told *= factor;
  told_squared *= factor;
  product *= factor;
}

void MotionLag::Sums::add(const Sums& other, double sign) {
  seen += sign * other.seen;
  seen_squared += sign * other.seen_squared;
  told += sign * other.told;
  told_squared += sign * other.told_squared;
  product += sign * other.product;
}

void MotionLag::Evidence::add(const Evidence& other, double sign) {
  weight += sign * other.weight;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    axes.at(axis).add(other.axes.at(axis), sign);
  }
}

MotionLag::Row MotionLag::Evidence::misfit() const {
  // seen = gain told + offset + noise of unknown variance, least squares per axis:
  //     -2 log likelihood = n log(residual variance) + constant
  Row misfit = Row::Zero();
  for (const Sums& sums : axes) {
    const double variance = sums.seen_squared / weight - std::pow(sums.seen / weight, 2);
    if (variance <= 0.0) continue;
    const Row told_variance = sums.told_squared / weight - (sums.told / weight).square();
    const Row covariance = sums.product / weight - sums.seen * sums.told / (weight * weight);
    const double least = 1e-12 + 1e-9 * told_variance.maxCoeff();
    // Odometry that runs against the motion tells nothing.
    const Row explained = covariance.max(0.0).square() / told_variance.max(least);
    misfit += weight * (1.0 - (explained / variance).min(1.0 - 1e-9)).log();
  }
  return misfit;
}

std::optional<LagReading> MotionLag::reading() const {
  Evidence all;
  for (const Evidence& group : groups_) all.add(group, 1.0);
  auto reading = best(all);
  if (!reading) return std::nullopt;
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const Evidence& group : groups_) {
    if (group.weight <= 0.0) continue;
    Evidence others = all;
    others.add(group, -1.0);
    const auto without = best(others);
    if (!without) continue;
    const double change_s = without->lag_s - reading->lag_s;
    sum += change_s;
    squares += change_s * change_s;
    count += 1.0;
  }
  if (count >= 2.0) {
    const double variance = (count - 1.0) / count * (squares - sum * sum / count);
    reading->sigma_s = std::max(reading->sigma_s, std::sqrt(std::max(variance, 0.0)));
  }
  return reading;
}

std::optional<LagReading> MotionLag::best(const Evidence& evidence) {
  if (evidence.weight < kFewestPairs) return std::nullopt;
  const Row misfit_at = evidence.misfit();
  Eigen::Index best = 0;
  const double least = misfit_at.minCoeff(&best);
  if (misfit_at.maxCoeff() - least < kClear) return std::nullopt;
  if (best < kReach || best >= kCandidates - kReach) return std::nullopt;
  // Parabola a + b i + c i^2 by least squares through the candidates i = -reach .. reach.
  double s0 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  double i2 = 0.0;
  double i4 = 0.0;
  for (int i = -kReach; i <= kReach; ++i) {
    const double y = misfit_at[best + i] - least;
    s0 += y;
    s1 += i * y;
    s2 += i * i * y;
    i2 += i * i;
    i4 += std::pow(i, 4);
  }
  const double n = 2.0 * kReach + 1.0;
  const double c = (n * s2 - i2 * s0) / (n * i4 - i2 * i2);
  const double b = s1 / i2;
  if (c <= 0.0) return std::nullopt;
  const double shift = std::clamp(-0.5 * b / c, -1.0 * kReach, 1.0 * kReach);
  return LagReading{kFirst_s + (static_cast<double>(best) + shift) * kStep_s,
                    kStep_s / std::sqrt(c)};
}

}  // namespace nadir::fusion
