#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fusion/correction.h"
#include "fusion/fuse/fuse_config.h"
#include "fusion/fuse/fuse_logs.h"
#include "fusion/fusion_health.h"
#include "fusion/motion_lag.h"

namespace nadir::fusion {

/// Along which line the filter propagates its covariances.
enum class FilterKind : std::uint8_t {
  kNominal,  ///< AlongNominal
  kEkf       ///< AboutEstimate
};

struct FuseLogs {
  std::vector<OdometryRow> odometry;
  std::vector<VisionRow> vision;
  /// May be empty: the nominal motion is then made from the odometry (see fuse).
  std::vector<NominalRow> nominal;
};

/// What was known at the time of an odometry row.
struct EstimateRow {
  double t_s = 0.0;
  /// Nothing before the first pose (or known start).
  std::optional<Estimate> estimate;
};

/// What the filter made of a row of the vision log when it arrived.
struct VisionDecision {
  Correction correction;
  int line = 0;
};

struct FuseRun {
  std::vector<EstimateRow> estimates;     ///< one an odometry row
  std::vector<VisionDecision> decisions;  ///< one a vision row that arrived in time
  FusionHealth health;                    ///< at the end; verdicts as they stand then
  /// By how much vision still sees the motion later than odometry tells it, beyond the lead and the
  /// delay of the configuration.
  std::optional<LagReading> lag;
  std::size_t not_arrived = 0;  ///< vision rows that arrive after the last odometry row
};

/// Plays the logs to the DelayedFusion that runs on a robot, in the order in which a robot hears
/// them, and notes the estimate at each odometry row: nothing that arrives later is in it.
///
/// The filter along the nominal trajectory wants the motion that was planned. Without a log of it,
/// nominal are the measured rates and the heading that the filter held at that moment; unlike the
/// EKF's, this line stays as it was when late poses change the estimate. Before the first pose the
/// nominal heading is that of the first row of the vision log, carried on by the odometry.
FuseRun fuse(const FuseLogs& logs, const FuseConfig& config, FilterKind kind);

}  // namespace nadir::fusion
