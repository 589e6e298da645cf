#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control_client/experiment/estimator_kinds.h"
#include "control_client/experiment/experiment.h"

namespace nadir::control_client {

/// One line of conditions of an experiment: the same run for many seeds.
struct ExperimentCase {
  std::string label;  ///< of the conditions; cases that differ in their driver alone share it
  Scenario scenario;
  std::vector<EstimatorKind> estimators;  ///< the first drives
  double rim_sigma_mps = 0.03;            ///< of the filters
  bool has_bound = false;                 ///< with the Cramer-Rao bounds, for white odometry noise
};

/// An experiment of the papers, or a study around them.
struct Experiment {
  std::string name;
  std::string description;  ///< one line
  std::uint64_t first_seed = 1000;
  int runs = 40;
  std::vector<ExperimentCase> cases;
};

/// All experiments of nadir-client, in the order in which they are listed.
const std::vector<Experiment>& experiments();
/// Null if none has this name.
const Experiment* find_experiment(const std::string& name);

}  // namespace nadir::control_client
