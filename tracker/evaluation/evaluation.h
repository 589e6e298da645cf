#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tracker/evaluation/error_statistics.h"
#include "tracker/evaluation/evaluation_logs.h"

namespace nadir::tracker {

struct EvaluationOptions {
  double radius_m = 0.1;   ///< a report farther from a true robot than this is not that robot
  bool anonymous = false;  ///< the numbers of the reports are track numbers, not those of the truth
};

/// A tracker's reports against the truth of the same recording.
struct Evaluation {
  using RobotName = std::pair<std::string, int>;  ///< team and number, those of the truth

  std::size_t frames = 0;                ///< of the truth
  std::size_t frames_without_truth = 0;  ///< reported, but unknown to the truth; not judged
  std::size_t true_robots = 0;           ///< sum over the frames
  std::size_t found = 0;                 ///< reported near the truth under the right name
  /// Reported near the truth under another name; for anonymous robots: of another team, or under
  /// another track number than before.
  std::size_t wrong_names = 0;
  std::size_t false_robots = 0;  ///< reported where no robot is, or a second time
  std::map<RobotName, std::vector<PoseError>> errors;  ///< of all robots found
};

/// Pairs reports with true robots frame by frame: those of the same name first, then the nearest
/// ones.
Evaluation evaluate(const std::vector<LoggedFrame>& truth, const std::vector<LoggedFrame>& poses,
                    const EvaluationOptions& options = {});

/// Poses that a second process received of those that the tracker logged.
struct Reception {
  std::size_t logged = 0;
  std::size_t received = 0;
  std::size_t lost = 0;         ///< logged, never received
  double latency_p50_us = 0.0;  ///< published to received
  double latency_p99_us = 0.0;
  double frame_rate_hz = 0.0;  ///< frames that arrived per second
};

Reception judge_reception(const std::vector<LoggedFrame>& poses,
                          const std::vector<ReceivedPose>& received);

}  // namespace nadir::tracker
