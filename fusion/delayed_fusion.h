#pragma once

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "fusion/frame_history.h"
#include "fusion/fusion_health.h"
#include "fusion/interval_history.h"
#include "fusion/odometry_check.h"
#include "fusion/pose_filter.h"
#include "fusion/vision_pose.h"

namespace nadir::fusion {

/// How much a DelayedFusion remembers; all memory is taken at construction. A late pose is inserted
/// where the history still holds at least (blocks - 1) * block_length intervals.
struct HistorySize {
  std::size_t block_length = 20;  ///< intervals from one kept filter state to the next
  std::size_t blocks = 11;        ///< at least 2; the default is a second at 200 Hz
  std::size_t poses = 50;
};

/// The whole story onboard: odometry comes at once, poses come late, in any order, several at a
/// time, twice or wrong, and there is one estimate. A pose is inserted where it was captured, in
/// the middle of an odometry interval if need be, and everything since is computed again, gates
/// included. So the estimate is the one of a filter that had got everything in the order of capture
/// (theory 3.2), to the last bit.
///
/// The filter starts at a known place (start) or with the first pose. Nothing is allocated after
/// construction, nothing throws, nothing is logged: each input gets its verdict.
template <class Linearization = AboutEstimate,
          OdometryErrorModel OdometryError = WhiteOdometryNoise>
class DelayedFusion {
 public:
  using Filter = PoseFilter<Linearization, OdometryError>;
  using Nominal = typename Filter::Nominal;

  struct Settings {
    typename Filter::Settings filter;
    HistorySize history;
    OdometryCheck odometry;
    /// A pose may be captured so much later than odometry: about one period of it.
    std::chrono::nanoseconds future_tolerance = std::chrono::milliseconds(20);
  };

  /// Mean body rates over [from, to], from encoders.
  struct Odometry {
    Timestamp from{0};
    Timestamp to{0};
    BodyRates mean_rates;
    [[no_unique_address]] Nominal nominal;
  };

  DelayedFusion() : DelayedFusion(Settings{}) {}
  explicit DelayedFusion(const Settings& settings)
      : settings_(settings),
        filter_(settings.filter),
        intervals_(settings.history.blocks, settings.history.block_length),
        frames_(settings.history.poses),
        snapshots_(settings.history.blocks) {}

  /// Forgets all and starts at a known place. The covariance is symmetric positive definite.
  void start(Timestamp time, const PlanarPose& pose, const PoseCovariance& covariance);

  /// In the order of time.
  OdometryVerdict add_odometry(const Odometry& odometry);

  /// Inserts a pose and computes again what came after it.
  Correction add_pose(const VisionPose& pose);

  /// Several at once, computed again once. `results` is as long as `poses`.
  void add_poses(std::span<const VisionPose> poses, std::span<Correction> results);

  /// At the end of the newest odometry; nothing before the start.
  std::optional<Estimate> estimate() const { return estimate_at(now()); }

  /// At a later time with the last rates kept, or at a time within the history with the poses
  /// captured until then; nothing before the start or the history.
  std::optional<Estimate> estimate_at(Timestamp time) const;

  Timestamp now() const { return intervals_.newest(); }
  FusionHealth health() const;

  /// The filter as it stands now() with the poses captured until then.
  const Filter& filter() const { return filter_; }
  /// The poses in the history, in the order of capture.
  std::span<const FrameRecord> frames() const { return frames_.records(); }
  /// Poses captured at this time or before are too old.
  Timestamp horizon() const { return intervals_.oldest(); }
  const Settings& settings() const { return settings_; }
  /// All that it holds, bytes.
  std::size_t memory_bytes() const;

 private:
  using Intervals = IntervalHistory<Nominal>;

  // The state between two intervals beside the filter's own.
  struct Track {
    std::optional<BodyRates> last_rates;
    double last_interval_s = 0.0;  // for which these were measured or, in a gap, assumed
    std::optional<Timestamp> last_used;
  };
  struct Snapshot {
    typename Filter::State state;
    Track track;
  };

  void restart(Timestamp from);
  void push(const typename Intervals::Interval& interval);
  void forget_block();
  std::optional<PoseVerdict> refusal(const VisionPose& pose) const;
  PoseVerdict insert(const VisionPose& pose);
  template <class Report>
  void replay(Timestamp capture, Report report);
  template <class Report>
  void run_live(std::uint64_t index, std::size_t& next_frame, Report report);
  template <class Report>
  void run(Filter& filter, Track& track, std::uint64_t index, Timestamp until,
           std::size_t& next_frame, Report report) const;
  void decide(FrameRecord& record, const Correction& correction);
  Snapshot& snapshot(std::uint64_t index) {
    return snapshots_[index / intervals_.block_length() % snapshots_.size()];
  }
  Estimate estimate_of(const Filter& filter, const Track& track, Timestamp time) const;

  Settings settings_;
  Filter filter_;
  Track track_;
  bool has_time_ = false;
  Intervals intervals_;
  FrameHistory frames_;
  std::vector<Snapshot> snapshots_;
  OdometryClock clock_;
  std::array<std::uint64_t, kPoseVerdicts> pose_counts_ = {};
  std::array<std::uint64_t, kOdometryVerdicts> odometry_counts_ = {};
  std::uint64_t revised_ = 0;
};

}  // namespace nadir::fusion

#include "fusion/delayed_fusion_impl.h"
