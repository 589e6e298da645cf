// control_tables: the experiments of estimation and control beside an independent simulation of the
// same scenarios.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "control_client/experiment/experiment_report.h"
#include "control_client/experiment/experiment_runner.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/control_reference.h"
#include "tests/bench/json_file.h"

namespace {

using nadir::bench::ControlReference;
using nadir::control_client::CaseResult;
using nadir::control_client::ExperimentResult;
using nadir::control_client::PoseErrors;

struct Options {
  std::string json_file;
  std::string only;
  int runs = 40;
};

std::optional<PoseErrors> errors_of(const CaseResult& each, const ControlReference& reference) {
  if (each.label != reference.label) return std::nullopt;
  if (!reference.driver.empty() &&
      nadir::control_client::estimator_name(each.estimators.front()) != reference.driver) {
    return std::nullopt;
  }
  if (reference.estimator.empty()) return each.summary.mean.to_nominal;
  for (std::size_t i = 0; i < each.estimators.size(); ++i) {
    if (nadir::control_client::estimator_name(each.estimators[i]) == reference.estimator) {
      return each.summary.mean.estimates[i].error;
    }
  }
  if (!each.bounds) return std::nullopt;
  if (reference.estimator == "bound, delayed") return each.bounds->delayed;
  if (reference.estimator == "bound, no delay") return each.bounds->zero_delay;
  if (reference.estimator == "bound, smoothing") return each.bounds->smoothing;
  return std::nullopt;
}

std::vector<ExperimentResult> run_all(const Options& options) {
  std::vector<const nadir::control_client::Experiment*> wanted;
  for (const char* name :
       {"matched", "slip", "tracking", "command", "delay", "blackout", "shaping", "faults", "e7"}) {
    if (options.only.empty() || options.only == name) {
      wanted.push_back(nadir::control_client::find_experiment(name));
    }
  }
  if (wanted.empty()) throw std::runtime_error("no table is called " + options.only);
  std::vector<ExperimentResult> results(wanted.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < wanted.size(); i = next++) {
      const int runs = std::min(options.runs, wanted[i]->runs);
      results[i] = nadir::control_client::run_experiment(*wanted[i], wanted[i]->first_seed, runs);
    }
  };
  auto second = std::async(std::launch::async, work);
  work();
  second.get();
  return results;
}

nlohmann::json compare(const std::vector<ExperimentResult>& results) {
  nlohmann::json rows = nlohmann::json::array();
  fmt::print("{:<9} {:<26} {:<20} {:<20} {:>9} {:>9} {:>6} {:>7} {:>7} {:>6}\n", "table",
             "conditions", "driver", "estimate of", "mm", "expected", "ratio", "deg", "exp.",
             "ratio");
  for (const ControlReference& reference : nadir::bench::control_references()) {
    for (const ExperimentResult& result : results) {
      if (result.name != reference.experiment) continue;
      for (const CaseResult& each : result.cases) {
        const auto errors = errors_of(each, reference);
        if (!errors) continue;
        const double mm = 1e3 * errors->position_rms_m;
        const double deg = errors->heading_rms_rad * 180.0 / std::numbers::pi;
        fmt::print("{:<9} {:<26} {:<20} {:<20} {:>9.2f} {:>9.2f} {:>6.2f}", reference.experiment,
                   reference.label, reference.driver, reference.estimator, mm,
                   reference.position_mm, mm / reference.position_mm);
        if (reference.heading_deg > 0.0) {
          fmt::print(" {:>7.2f} {:>7.2f} {:>6.2f}", deg, reference.heading_deg,
                     deg / reference.heading_deg);
        }
        fmt::print("\n");
        rows.push_back({{"experiment", reference.experiment},
                        {"label", reference.label},
                        {"driver", reference.driver},
                        {"estimator", reference.estimator},
                        {"position_mm", mm},
                        {"expected_mm", reference.position_mm},
                        {"heading_deg", deg},
                        {"expected_deg", reference.heading_deg}});
      }
    }
  }
  fmt::print("\n");
  return rows;
}

void run(const Options& options) {
  const std::vector<ExperimentResult> results = run_all(options);
  const nlohmann::json rows = compare(results);
  nlohmann::json experiments = nlohmann::json::array();
  for (const ExperimentResult& result : results) {
    fmt::print("{}\n", nadir::control_client::text_report(result));
    experiments.push_back(nadir::control_client::json_report(result));
  }
  nadir::bench::write_json_file({{"benchmark", "control_tables"},
                                 {"runs", options.runs},
                                 {"compared", rows},
                                 {"experiments", experiments}},
                                options.json_file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Experiments of estimation and control beside their references.", "control_tables");
  app.footer("Example: control_tables --experiment tracking --runs 10");
  app.add_option("--json", options.json_file, "write the figures to this file too");
  app.add_option("--experiment", options.only, "only this one");
  app.add_option("--runs", options.runs, "seeds of each case")->check(CLI::Range(1, 1000));
  return nadir::bench::bench_main(argc, argv, app, [&options] { run(options); });
}
