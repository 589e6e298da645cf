#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion/fuse/fuse_run.h"
#include "fusion/fuse/fuse_score.h"

namespace nadir::fusion {

/// EST.csv of the contract; nan where nothing is known yet.
std::string estimates_csv(const std::vector<EstimateRow>& rows);

/// SUMMARY.json of the contract, and how often each verdict fell. Errors are null without truth.
std::string summary_json(const FuseRun& run, const std::optional<FuseScore>& score);

/// The errors in a line.
std::string score_text(const FuseScore& score);

/// The summary for a person, a few lines; then a line for each kind of row that was refused for
/// what it is, with the first such row. `vision_file` is for these lines.
std::string summary_text(const FuseRun& run, const std::optional<FuseScore>& score,
                         const std::string& vision_file);

}  // namespace nadir::fusion
