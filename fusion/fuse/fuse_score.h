#pragma once

#include <string>
#include <vector>

#include "fusion/fuse/fuse_logs.h"
#include "fusion/fuse/fuse_run.h"

namespace nadir::fusion {

/// Errors of the estimates against the truth.
struct FuseScore {
  std::size_t compared = 0;  ///< estimates with truth on both sides in time
  double position_rms_m = 0.0;
  double position_max_m = 0.0;
  double heading_rms_rad = 0.0;
  double nees = 0.0;  ///< mean normalised estimation error squared, expectation 3
};

/// Truth at a time, linear between its rows, the heading on the shorter way; nothing outside or in
/// a gap longer than three times the median distance of the rows (at least 0.1 s).
class TruthLine {
 public:
  explicit TruthLine(std::vector<TruthRow> rows);
  std::optional<PlanarPose> at(double t_s) const;

 private:
  std::vector<TruthRow> rows_;
  double longest_gap_s_ = 0.1;
};

FuseScore score(const std::vector<EstimateRow>& estimates, const TruthLine& truth);

/// The counts of the contract: each vision row that arrived is in one of them.
struct VisionCounts {
  std::uint64_t accepted = 0;   ///< within the gate, and the first
  std::uint64_t rejected = 0;   ///< beyond the gate, or refused for what the row is
  std::uint64_t recovered = 0;  ///< beyond the gate, but believed: like others before it
};
VisionCounts count_vision(const FusionHealth& health);

/// Mean normalised innovation squared of the accepted rows when they arrived; 0 without any.
double mean_nis(const std::vector<VisionDecision>& decisions);

}  // namespace nadir::fusion
