#pragma once

#include <Eigen/LU>
#include <optional>
#include <vector>

#include "fusion/pose_filter.h"

namespace nadir::fusion {

/// Where the robot was, by all that was measured before and after.
struct SmoothedPose {
  PlanarPose pose;
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// Rauch-Tung-Striebel smoother over a recorded log: the reference that no filter reaches, as it
/// knows the future. It drives a PoseFilter forward, in the order of capture, and keeps what each
/// prediction did; smooth() then goes back. Offline: its memory grows with the log.
template <class Linearization = AboutEstimate,
          OdometryErrorModel OdometryError = WhiteOdometryNoise>
class Smoother {
 public:
  using Filter = PoseFilter<Linearization, OdometryError>;
  using Nominal = typename Filter::Nominal;

  explicit Smoother(const typename Filter::Settings& settings) : filter_(settings) {}

  void start(const PlanarPose& pose, const PoseCovariance& covariance) {
    filter_.start(pose, covariance);
  }

  void predict(const OdometryStep& step, const Nominal& nominal = {}) {
    const State before = filter_.state();
    const Matrix transition = filter_.predict(step, nominal);
    keep(before, transition);
  }

  void predict_gap(const BodyRates& last_rates, double dt_s) {
    const State before = filter_.state();
    const Matrix transition = filter_.predict_gap(last_rates, dt_s);
    keep(before, transition);
  }

  Correction correct(const PlanarPose& measured, const PoseCovariance& covariance) {
    const State before = filter_.state();
    Correction correction = filter_.correct(measured, covariance);
    if (correction.verdict == PoseVerdict::kRecovered) {
      // The filter admitted to be lost by as much: noise that came in at this moment.
      State inflated = before;
      inflated.covariance.template topLeftCorner<3, 3>().diagonal() +=
          correction.innovation.cwiseAbs2();
      links_.push_back({before, inflated, Matrix::Identity()});
    } else if (correction.verdict == PoseVerdict::kReset) {
      // What comes after says nothing of what was before.
      links_.push_back({before, filter_.state(), Matrix::Zero()});
    }
    return correction;
  }

  /// Remembers the present moment; returns its index in the result of smooth().
  std::size_t mark() {
    marks_.push_back(links_.size());
    return marks_.size() - 1;
  }

  /// The poses at all marks; nothing before the start.
  std::vector<std::optional<SmoothedPose>> smooth() const;

  const Filter& filter() const { return filter_; }

 private:
  using State = typename Filter::State;
  using Matrix = typename Filter::Covariance;
  using Vector = Eigen::Matrix<double, Filter::kStates, 1>;

  // From one moment to the next, the corrections at either end done before or not yet.
  struct Link {
    State before;
    State after;
    Matrix transition;
  };

  void keep(const State& before, const Matrix& transition) {
    links_.push_back({before, filter_.state(), transition});
  }
  static Vector difference(const State& a, const State& b);
  static void add(const Vector& change, State* state);

  Filter filter_;
  std::vector<Link> links_;
  std::vector<std::size_t> marks_;  // number of links before each
};

template <class L, OdometryErrorModel E>
auto Smoother<L, E>::smooth() const -> std::vector<std::optional<SmoothedPose>> {
  // C = P+ F^T (P-)^-1 with P+ before the step, P- after it
  // xs = x+ + C (xs_next - x-),  Ps = P+ + C (Ps_next - P-) C^T
  std::vector<std::optional<SmoothedPose>> result(marks_.size());
  State smoothed = filter_.state();
  std::size_t mark = marks_.size();
  for (std::size_t i = links_.size() + 1; i-- > 0;) {
    for (; mark > 0 && marks_[mark - 1] == i; --mark) {
      if (!smoothed.has_started) continue;
      result[mark - 1] = SmoothedPose{smoothed.pose, smoothed.pose_covariance()};
    }
    if (i == 0) break;
    const Link& link = links_[i - 1];
    if (!link.before.has_started) {
      smoothed = link.before;
      continue;
    }
    const Matrix gain =
        link.before.covariance * link.transition.transpose() * link.after.covariance.inverse();
    const Vector change = gain * difference(smoothed, link.after);
    const Matrix covariance =
        link.before.covariance +
        gain * (smoothed.covariance - link.after.covariance) * gain.transpose();
    smoothed = link.before;
    add(change, &smoothed);
    smoothed.covariance = 0.5 * (covariance + covariance.transpose());
  }
  return result;
}

template <class L, OdometryErrorModel E>
auto Smoother<L, E>::difference(const State& a, const State& b) -> Vector {
  Vector difference;
  difference.template head<3>() = pose_difference(a.pose, b.pose);
  if constexpr (Filter::kErrorStates > 0) {
    difference.template tail<Filter::kErrorStates>() = a.odometry_error - b.odometry_error;
  }
  return difference;
}

template <class L, OdometryErrorModel E>
void Smoother<L, E>::add(const Vector& change, State* state) {
  state->pose = {state->pose.x_m + change[0], state->pose.y_m + change[1],
                 wrap_angle(state->pose.heading_rad + change[2])};
  if constexpr (Filter::kErrorStates > 0) {
    state->odometry_error += change.template tail<Filter::kErrorStates>();
  }
}

}  // namespace nadir::fusion
