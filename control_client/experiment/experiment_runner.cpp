#include "control_client/experiment/experiment_runner.h"

#include <cmath>
#include <memory>

#include "control_client/experiment/cramer_rao_bound.h"
#include "control_client/experiment/fusion_estimator.h"

namespace nadir::control_client {
namespace {

void add_mean_square(PoseErrors& sum, const PoseErrors& run, int runs) {
  sum.position_rms_m += run.position_rms_m * run.position_rms_m / runs;
  sum.heading_rms_rad += run.heading_rms_rad * run.heading_rms_rad / runs;
}

void take_root(PoseErrors& sum) {
  sum.position_rms_m = std::sqrt(sum.position_rms_m);
  sum.heading_rms_rad = std::sqrt(sum.heading_rms_rad);
}

void add_bounds(BoundErrors& sum, const RunRecord& record, const Eigen::Matrix3d& rate_covariance,
                int runs) {
  const auto errors = [&](BoundKind kind) {
    return bound_errors(record,
                        cramer_rao_bound(record, rate_covariance, known_start_covariance(), kind));
  };
  add_mean_square(sum.delayed, errors(BoundKind::kDelayed), runs);
  add_mean_square(sum.zero_delay, errors(BoundKind::kZeroDelay), runs);
  add_mean_square(sum.smoothing, errors(BoundKind::kSmoothing), runs);
}

}  // namespace

CaseResult run_case(const ExperimentCase& conditions, std::uint64_t first_seed, int runs) {
  const fusion::WheelGeometry geometry = RobotModel(conditions.scenario.robot).geometry();
  CaseResult result{conditions.label, conditions.estimators, {}, std::nullopt, {}};
  if (conditions.has_bound) result.bounds.emplace();
  std::vector<RunMetrics> metrics;
  for (int run = 0; run < runs; ++run) {
    std::vector<std::unique_ptr<Estimator>> owned;
    std::vector<Estimator*> estimators;
    for (const EstimatorKind kind : conditions.estimators) {
      owned.push_back(make_estimator(kind, geometry, conditions.rim_sigma_mps,
                                     conditions.scenario.control.tick_s));
      estimators.push_back(owned.back().get());
    }
    Scenario scenario = conditions.scenario;
    scenario.run_seed = first_seed + static_cast<std::uint64_t>(run);
    RunRecord record = run_scenario(scenario, estimators);
    metrics.push_back(measure(record));
    if (result.bounds) {
      add_bounds(*result.bounds, record, geometry.rate_covariance(conditions.rim_sigma_mps), runs);
    }
    if (run == 0) result.example = std::move(record);
  }
  result.summary = summarize(metrics);
  if (result.bounds) {
    take_root(result.bounds->delayed);
    take_root(result.bounds->zero_delay);
    take_root(result.bounds->smoothing);
  }
  return result;
}

ExperimentResult run_experiment(const Experiment& experiment, std::uint64_t first_seed, int runs,
                                const std::function<void(std::size_t)>& progress) {
  ExperimentResult result{experiment.name, first_seed, runs, {}};
  for (const ExperimentCase& conditions : experiment.cases) {
    result.cases.push_back(run_case(conditions, first_seed, runs));
    if (progress) progress(result.cases.size());
  }
  return result;
}

}  // namespace nadir::control_client
