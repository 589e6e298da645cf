// drive_loop: robots drive by what nadir-tracker sees of them, in real processes and real time.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bench/bench_program.h"
#include "tests/bench/drive_scenario.h"
#include "tests/bench/json_file.h"

namespace {

using nadir::bench::DriveResult;
using nadir::bench::DriveScenario;

constexpr double kGoal_mm = 2.0;
constexpr double kGoal_deg = 0.5;
constexpr double kGoalMissed = 0.001;
constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Options {
  std::string json_file;
  std::string only;
  double seconds = 60.0;
  double soak_seconds = 600.0;
  bool soaks = false;
};

std::vector<DriveScenario> scenarios(const Options& options) {
  if (options.soaks) {
    return {{.name = "soak", .duration_s = options.soak_seconds, .memory_every_s = 15.0}};
  }
  const double s = options.seconds;
  return {{.name = "undisturbed", .duration_s = s},
          {.name = "20 % of packets lost", .duration_s = s, .packet_loss = 0.2},
          {.name = "tracker killed", .duration_s = s, .kills_tracker = true},
          {.name = "blackout of 1 s", .duration_s = s, .blackout_s = 1.0},
          {.name = "20 robots", .robots = 20, .duration_s = 0.5 * s},
          {.name = "32 robots", .robots = 32, .duration_s = 0.5 * s}};
}

void print(const DriveResult& result) {
  fmt::print(
      "{} ({} robots, {:.0f} s): {:.2f} % of ticks missed; tracker {:.0f} % of a core, "
      "{:.0f} MB; client {:.1f} % and {:.1f} MB each\n",
      result.scenario.name, result.scenario.robots, result.scenario.duration_s,
      100.0 * result.ticks_missed_share(), 100.0 * result.tracker.cpu_share,
      result.tracker.memory_mb, 100.0 * result.client.cpu_share, result.client.memory_mb);
  fmt::print("{}", nadir::control_client::error_table(result.drives));
  const nadir::control_client::DriveError fused = result.fused();
  fmt::print("fused, all robots: {:.2f} mm, {:.2f} deg\n", 1e3 * fused.position_rms_m,
             kDegrees * fused.heading_rms_rad);
  for (const auto& sample : result.memory) {
    fmt::print("  {:6.0f} s  tracker {:.2f} MB  client {:.2f} MB\n", sample.time_s,
               sample.tracker_mb, sample.client_mb);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

nlohmann::json json(const DriveResult& result) {
  nlohmann::json memory = nlohmann::json::array();
  for (const auto& sample : result.memory) {
    memory.push_back({{"time_s", sample.time_s},
                      {"tracker_mb", sample.tracker_mb},
                      {"client_mb", sample.client_mb}});
  }
  return {{"name", result.scenario.name},
          {"robots", result.scenario.robots},
          {"duration_s", result.scenario.duration_s},
          {"ticks_missed_share", result.ticks_missed_share()},
          {"tracker_cpu_share", result.tracker.cpu_share},
          {"tracker_memory_mb", result.tracker.memory_mb},
          {"client_cpu_share", result.client.cpu_share},
          {"client_memory_mb", result.client.memory_mb},
          {"fused_position_rms_m", result.fused().position_rms_m},
          {"fused_heading_rms_rad", result.fused().heading_rms_rad},
          {"memory", memory},
          {"drives", nadir::control_client::error_json(result.drives)}};
}

void run(const Options& options) {
  fmt::print(
      "Robots drive by what the tracker sees of them: 50 Hz, 60 to 100 ms late, a tenth of "
      "the frames lost\ngoals, of each robot: fused {} mm and {} deg, {} % of ticks missed\n\n",
      kGoal_mm, kGoal_deg, 100.0 * kGoalMissed);
  nlohmann::json results = nlohmann::json::array();
  for (const DriveScenario& scenario : scenarios(options)) {
    if (!options.only.empty() && scenario.name != options.only) continue;
    const DriveResult result = nadir::bench::run_drive(scenario);
    print(result);
    results.push_back(json(result));
  }
  if (results.empty()) throw std::runtime_error("no scenario is called " + options.only);
  nadir::bench::write_json_file({{"benchmark", "drive_loop"},
                                 {"goal_position_rms_m", 1e-3 * kGoal_mm},
                                 {"goal_heading_rms_rad", kGoal_deg / kDegrees},
                                 {"goal_ticks_missed_share", kGoalMissed},
                                 {"scenarios", results}},
                                options.json_file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The loop of tracker and clients in real processes: errors, missed ticks, costs.",
               "drive_loop");
  app.footer("Example: drive_loop --seconds 20 --scenario undisturbed");
  app.add_option("--json", options.json_file, "write the figures to this file too");
  app.add_option("--scenario", options.only, "only this one");
  app.add_option("--seconds", options.seconds, "of each scenario")->check(CLI::Range(5.0, 1e5));
  app.add_flag("--soak", options.soaks, "ten minutes instead, with the memory of both processes");
  app.add_option("--soak-seconds", options.soak_seconds, "of the soak")
      ->check(CLI::Range(5.0, 1e6));
  return nadir::bench::bench_main(argc, argv, app, [&] { run(options); });
}
