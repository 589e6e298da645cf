#include "fusion/fuse/fuse_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <type_traits>

#include "fusion/delayed_fusion.h"

namespace nadir::fusion {
namespace {

/// Odometry is taken to have been valid already so long before its first row, so that a pose which
/// was captured together with it can be used.
constexpr std::chrono::nanoseconds kBeforeFirstRow = std::chrono::milliseconds(1);
constexpr std::size_t kMostIntervals = 1U << 20U;

/// Log times as positive time stamps.
class LogClock {
 public:
  explicit LogClock(double first_s) : shift_s_(first_s > 1.0 ? 0.0 : 10.0 - first_s) {}

  Timestamp stamp(double t_s) const { return from_seconds(t_s + shift_s_); }
  double seconds(Timestamp stamp) const { return to_seconds(stamp) - shift_s_; }

 private:
  double shift_s_;
};

/// The largest number of rows within a span of time.
template <class Rows, class Time>
std::size_t most_rows_within(const Rows& rows, double span_s, Time time) {
  std::size_t most = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    while (time(rows[i]) - time(rows[first]) > span_s) ++first;
    most = std::max(most, i - first + 1);
  }
  return most;
}

HistorySize history_size(const FuseLogs& logs, const FuseConfig& config) {
  HistorySize size;
  const double span_s = config.history_s + std::abs(config.odometry_lead_s);
  const std::size_t intervals = std::min(
      most_rows_within(logs.odometry, span_s, [](const OdometryRow& row) { return row.t_s; }),
      kMostIntervals);
  // One block more, as whole blocks are forgotten, and one for gaps.
  size.blocks = std::max(size.blocks, intervals / size.block_length + 3);
  const std::size_t poses = most_rows_within(logs.vision, 2.0 * span_s,
                                             [](const VisionRow& row) { return row.t_arrival_s; });
  size.poses = std::max(size.poses, poses + 1);
  return size;
}

/// Gives equal rows the same frame number, so that doubles are recognised.
class FrameNumbers {
 public:
  std::uint64_t number(const VisionRow& row) {
    const std::array<double, 4> key = {row.t_capture_s, row.pose.x_m, row.pose.y_m,
                                       row.pose.heading_rad};
    ++rows_;
    if (!std::all_of(key.begin(), key.end(), [](double x) { return std::isfinite(x); })) {
      return rows_;
    }
    return numbers_.try_emplace(key, rows_).first->second;
  }

 private:
  std::uint64_t rows_ = 0;
  std::map<std::array<double, 4>, std::uint64_t> numbers_;
};

/// The planned motion, from its log or from what is known (see fuse).
class NominalMotion {
 public:
  explicit NominalMotion(const FuseLogs& logs) : logs_(logs) {
    if (!logs.vision.empty()) heading_rad_ = logs.vision.front().pose.heading_rad;
  }

  /// Over the interval that begins at row `index` of the odometry, t_s long.
  AlongNominal::Nominal at(std::size_t index, double duration_s,
                           const std::optional<Estimate>& estimate) {
    const OdometryRow& row = logs_.odometry[index];
    while (next_ < logs_.nominal.size() && logs_.nominal[next_].t_s <= row.t_s) ++next_;
    if (!logs_.nominal.empty()) {
      const NominalRow& planned = logs_.nominal[next_ == 0 ? 0 : next_ - 1];
      return {planned.heading_rad, planned.rates};
    }
    if (estimate) heading_rad_ = estimate->pose.heading_rad;
    const AlongNominal::Nominal nominal = {heading_rad_, row.rates};
    if (row.rates.is_finite()) heading_rad_ += row.rates.r_radps * duration_s;
    return nominal;
  }

 private:
  const FuseLogs& logs_;
  std::size_t next_ = 0;
  double heading_rad_ = 0.0;
};

template <class Fusion>
class LogPlayer {
 public:
  LogPlayer(const FuseLogs& logs, const FuseConfig& config,
            const typename Fusion::Settings& settings)
      : logs_(logs),
        config_(config),
        clock_(logs.odometry.front().t_s),
        fusion_(settings),
        nominal_(logs) {}

  FuseRun play() {
    FuseRun run;
    if (config_.start) begin(*config_.start);
    for (std::size_t i = 0; i < logs_.odometry.size(); ++i) {
      hear_odometry(i);
      const double t_s = logs_.odometry[i].t_s;
      hear_vision(t_s, &run.decisions);
      run.estimates.push_back({t_s, known_at(t_s)});
    }
    run.health = fusion_.health();
    run.lag = lag_.reading();
    run.not_arrived = logs_.vision.size() - next_vision_;
    return run;
  }

 private:
  void begin(const KnownStart& start) {
    const double variance_m2 = start.sigma_m * start.sigma_m;
    const Eigen::Vector3d variances(variance_m2, variance_m2, start.sigma_rad * start.sigma_rad);
    fusion_.start(clock_.stamp(logs_.odometry.front().t_s) - kBeforeFirstRow, start.pose,
                  variances.asDiagonal());
  }

  /// Row i says until when the rates of the row before were valid.
  void hear_odometry(std::size_t i) {
    const std::size_t valid = i == 0 ? 0 : i - 1;
    const Timestamp lead = from_seconds(config_.odometry_lead_s);
    Timestamp from = clock_.stamp(logs_.odometry[valid].t_s) + lead;
    const Timestamp to = clock_.stamp(logs_.odometry[i].t_s) + lead;
    if (i == 0) from = std::min(from, from - lead) - kBeforeFirstRow;
    // Nobody drives on for so long on one measurement: a gap, which ends here.
    const OdometryCheck& check = config_.odometry_check;
    if (to - from > check.longest_interval) {
      from = to - check.join_tolerance - kBeforeFirstRow;
    }
    typename Fusion::Odometry odometry{from, to, logs_.odometry[valid].rates, {}};
    if constexpr (std::is_same_v<typename Fusion::Nominal, AlongNominal::Nominal>) {
      odometry.nominal = nominal_.at(valid, to_seconds(to - from), fusion_.estimate());
    }
    if (is_used(fusion_.add_odometry(odometry))) {
      lag_.add_odometry(odometry.from, odometry.to, odometry.mean_rates);
    }
  }

  void hear_vision(double t_s, std::vector<VisionDecision>* decisions) {
    poses_.clear();
    const std::size_t first = next_vision_;
    for (; next_vision_ < logs_.vision.size() && logs_.vision[next_vision_].t_arrival_s <= t_s;
         ++next_vision_) {
      const VisionRow& row = logs_.vision[next_vision_];
      poses_.push_back({0, 0, frame_numbers_.number(row),
                        clock_.stamp(row.t_capture_s - config_.vision_undeclared_delay_s), row.pose,
                        row.covariance()});
    }
    if (poses_.empty()) return;
    corrections_.resize(poses_.size());
    fusion_.add_poses(poses_, corrections_);
    for (std::size_t i = 0; i < corrections_.size(); ++i) {
      decisions->push_back({corrections_[i], logs_.vision[first + i].line});
      if (is_used(corrections_[i].verdict)) lag_.add_pose(poses_[i].capture, poses_[i].pose);
    }
  }

  std::optional<Estimate> known_at(double t_s) const {
    const auto estimate = fusion_.estimate_at(clock_.stamp(t_s));
    return estimate ? estimate : fusion_.estimate();
  }

  const FuseLogs& logs_;
  const FuseConfig& config_;
  LogClock clock_;
  Fusion fusion_;
  NominalMotion nominal_;
  FrameNumbers frame_numbers_;
  MotionLag lag_;
  std::size_t next_vision_ = 0;
  std::vector<VisionPose> poses_;
  std::vector<Correction> corrections_;
};

template <class Fusion>
FuseRun play(const FuseLogs& logs, const FuseConfig& config) {
  typename Fusion::Settings settings;
  settings.filter.gate = config.gate;
  settings.filter.recovery = config.recovery;
  settings.filter.gap = config.gap;
  settings.filter.odometry_error = config.walk.noise();
  settings.history = history_size(logs, config);
  settings.odometry = config.odometry_check;
  // Odometry that comes late ends so much before the newest pose.
  settings.future_tolerance =
      from_seconds(config.vision_future_tolerance_s + std::max(0.0, -config.odometry_lead_s));
  return LogPlayer<Fusion>(logs, config, settings).play();
}

}  // namespace

FuseRun fuse(const FuseLogs& logs, const FuseConfig& config, FilterKind kind) {
  if (kind == FilterKind::kNominal) return play<DelayedFusion<AlongNominal>>(logs, config);
  return play<DelayedFusion<AboutEstimate>>(logs, config);
}

}  // namespace nadir::fusion
