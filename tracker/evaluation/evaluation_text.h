#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracker/evaluation/evaluation.h"

namespace nadir::tracker {

/// Stage times of a pose log, microseconds.
struct StageSummary {
  double detect_p50_us = 0.0;
  double total_p50_us = 0.0;
  double total_p99_us = 0.0;
};
StageSummary summarise_stages(const std::vector<LoggedFrame>& poses);

/// A table for a person: a line for each robot, then all of them, the pixels, the honesty, the
/// times.
std::string evaluation_table(const Evaluation& evaluation, const StageSummary& stages,
                             const std::optional<Reception>& reception);

/// The same numbers, and a few more, as one JSON object; angles in rad, lengths in m.
std::string evaluation_json(const Evaluation& evaluation, const StageSummary& stages,
                            const std::optional<Reception>& reception);

}  // namespace nadir::tracker
