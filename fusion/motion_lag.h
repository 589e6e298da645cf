#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "fusion/body_rates.h"
#include "fusion/planar_pose.h"
#include "fusion/timestamp.h"

namespace nadir::fusion {

/// By how much the motion that vision sees is later than the motion that odometry tells: commanded
/// velocities that lead the motion and frames older than their stamps both make it positive, and
/// only the sum of the two can be seen.
struct LagReading {
  double lag_s = 0.0;
  double sigma_s = 0.0;
};

/// Finds a constant lag of any size between -0.3 and 0.6 s. The motion between two poses about a
/// third of a second apart is compared with the odometry of that time, once for each candidate lag:
/// per axis of the robot by a linear regression with a free gain and offset, so that neither a
/// wrong wheel radius nor a biased gyro matters. The lag with the least residual is the answer. Its
/// sigma is the larger of two: from the curvature of the log likelihood, and from how much the
/// answer changes when an eighth of the time is left out (jackknife), as errors of odometry last
/// longer than a pair of poses. Fixed memory, no allocation.
class MotionLag {
 public:
  struct Settings {
    double base_s = 0.3;      ///< between the poses that are compared
    double memory_s = 600.0;  ///< after so long a pair of poses counts 1/e
  };

  MotionLag() : MotionLag(Settings{}) {}
  explicit MotionLag(const Settings& settings) : settings_(settings) {}

  /// Mean rates over an interval, in the order of time.
  void add_odometry(Timestamp from, Timestamp to, const BodyRates& mean_rates);
  /// Poses that were believed; those that come out of order are left out.
  void add_pose(Timestamp capture, const PlanarPose& pose);

  /// Nothing while the motion was too uniform to tell.
  std::optional<LagReading> reading() const;

 private:
  static constexpr int kCandidates = 91;
  static constexpr double kFirst_s = -0.3;
  static constexpr double kStep_s = 0.01;
  static constexpr std::size_t kPathPoints = 512;
  static constexpr std::size_t kPairs = 32;
  static constexpr std::size_t kGroups = 8;
  using Row = Eigen::Array<double, 1, kCandidates>;

  // Integral of the rates since some start.
  struct PathPoint {
    Timestamp time{0};
    Eigen::Array3d path = Eigen::Array3d::Zero();
  };
  // Motion between two poses, along the robot's axes in the middle of it.
  struct Pair {
    Timestamp from{0};
    Timestamp to{0};
    Eigen::Array3d moved = Eigen::Array3d::Zero();
  };
  // Sums over pairs for one axis: seen, told, and their products.
  struct Sums {
    double seen = 0.0;
    double seen_squared = 0.0;
    Row told = Row::Zero();
    Row told_squared = Row::Zero();
    Row product = Row::Zero();

    void scale(double factor);
    void add(const Sums& other, double sign);
  };
  struct Evidence {
    double weight = 0.0;
    std::array<Sums, 3> axes = {};

    void add(const Evidence& other, double sign);
    Row misfit() const;
  };

  const PathPoint& point(std::size_t index) const { return path_[(first_ + index) % kPathPoints]; }
  std::optional<Eigen::Array3d> path_at(Timestamp time) const;
  void compare(const Pair& pair);
  static std::optional<LagReading> best(const Evidence& evidence);

  Settings settings_;
  std::array<PathPoint, kPathPoints> path_ = {};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::array<Pair, kPairs> pairs_ = {};
  std::size_t first_pair_ = 0;
  std::size_t pair_count_ = 0;
  std::optional<Timestamp> anchor_time_;
  PlanarPose anchor_;
  Timestamp last_compared_{0};
  std::array<Evidence, kGroups> groups_ = {};
};

}  // namespace nadir::fusion
