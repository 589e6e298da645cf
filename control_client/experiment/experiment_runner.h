#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "control_client/experiment/experiment_catalogue.h"
#include "control_client/experiment/run_metrics.h"

namespace nadir::control_client {

/// Root mean squares that the Cramer-Rao bounds allow.
struct BoundErrors {
  PoseErrors delayed;
  PoseErrors zero_delay;
  PoseErrors smoothing;
};

/// A case over all its seeds.
struct CaseResult {
  std::string label;
  std::vector<EstimatorKind> estimators;  ///< the first drove
  Summary summary;
  std::optional<BoundErrors> bounds;
  RunRecord example;  ///< the first seed's run
};

struct ExperimentResult {
  std::string name;
  std::uint64_t first_seed = 0;
  int runs = 0;
  std::vector<CaseResult> cases;
};

/// One case for `runs` seeds from `first_seed`.
CaseResult run_case(const ExperimentCase& conditions, std::uint64_t first_seed, int runs);

/// All cases. `progress` hears the number of cases done after each.
ExperimentResult run_experiment(const Experiment& experiment, std::uint64_t first_seed, int runs,
                                const std::function<void(std::size_t)>& progress = {});

}  // namespace nadir::control_client
