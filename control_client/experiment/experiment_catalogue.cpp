#include "control_client/experiment/experiment_catalogue.h"

#include <fmt/format.h>

#include <algorithm>

namespace nadir::control_client {
namespace {

// Seeds of S0's and S2's qualitative experiments are chosen here: estimation from 1000, tracking
// from 2000, vision alone from 3000.
constexpr std::uint64_t kEstimationSeed = 1000;
constexpr std::uint64_t kTrackingSeed = 2000;
constexpr std::uint64_t kVisionSeed = 3000;
constexpr int kRuns = 40;

const std::vector<std::string> kFive = {"square-turning", "square", "circle", "rose3", "rose4"};

Scenario scenario(const std::string& trajectory) {
  Scenario scenario;
  scenario.trajectory = standard_trajectory(trajectory);
  return scenario;
}

Scenario slow_inner(const std::string& trajectory) {
  Scenario slow = scenario(trajectory);
  slow.control.inner_steps = 1;
  return slow;
}

/// The drivers of a scenario, a case each.
std::vector<ExperimentCase> driven_by(const std::vector<EstimatorKind>& drivers,
                                      const std::string& label, const Scenario& scenario,
                                      double rim_sigma_mps = 0.03) {
  std::vector<ExperimentCase> cases;
  cases.reserve(drivers.size());
  for (const EstimatorKind driver : drivers) {
    cases.push_back({label, scenario, {driver}, rim_sigma_mps});
  }
  return cases;
}

void append(std::vector<ExperimentCase>& cases, std::vector<ExperimentCase> more) {
  cases.insert(cases.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

/// S0's experiments: one trajectory with fusion, encoders alone and vision alone.
Experiment of_the_paper(const std::string& name, const std::string& description,
                        const std::vector<std::string>& trajectories) {
  Experiment experiment{name, description, kTrackingSeed, kRuns, {}};
  for (const std::string& trajectory : trajectories) {
    append(experiment.cases,
           driven_by({EstimatorKind::kFusion, EstimatorKind::kEncoders, EstimatorKind::kVision},
                     trajectory, scenario(trajectory)));
  }
  return experiment;
}

/// S3's race at 25 Hz; behind x = -0.05 m the light is bad.
Experiment race(const std::string& name, const std::string& description,
                const std::vector<EstimatorKind>& estimators) {
  Scenario race;
  race.trajectory = step_trajectory(Eigen::Vector3d::Zero(), 30.0);  // starts in the middle
  race.race.emplace();
  race.control.tick_s = 0.04;
  race.control.inner_steps = 8;
  race.encoders.tick_s = race.control.tick_s;
  race.vision.ticks_per_frame = 1;
  race.vision.min_delay_s = 0.0;
  race.vision.max_delay_s = 0.0;
  race.vision.loss = 0.0;
  race.vision.outliers = 0.0;
  race.vision.min_pixels = 30.0;
  race.vision.dim_below_x_m = -0.05;
  return {name, description, kEstimationSeed, kRuns, {{"race", race, estimators}}};
}

/// For a trajectory of one's own.
Experiment follow() {
  Experiment experiment{"follow",
                        "fusion, encoders and vision alone on --trajectory, exact nominal",
                        kTrackingSeed,
                        10,
                        {}};
  Scenario exact = scenario("circle");
  exact.nominal.kind = NominalKind::kExact;
  experiment.cases = driven_by(
      {EstimatorKind::kFusion, EstimatorKind::kEncoders, EstimatorKind::kVision}, "", exact);
  return experiment;
}

Experiment matched() {
  Experiment experiment{"matched",
                        "estimation with the odometry noise that the filter assumes",
                        kEstimationSeed,
                        kRuns,
                        {}};
  for (const int ticks_per_frame : {1, 2}) {
    for (const char* trajectory : {"square-turning", "circle"}) {
      ExperimentCase each{
          fmt::format("{}, {} Hz", trajectory, 50 / ticks_per_frame),
          slow_inner(trajectory),
          {EstimatorKind::kFusion, EstimatorKind::kEkf, EstimatorKind::kEncoders,
           EstimatorKind::kVision, EstimatorKind::kFusionNoGate, EstimatorKind::kFusionNoReplay},
          0.02,
          true};
      each.scenario.encoders.kind = EncoderKind::kWhite;
      each.scenario.vision.ticks_per_frame = ticks_per_frame;
      experiment.cases.push_back(each);
    }
  }
  return experiment;
}

Experiment slip() {
  Experiment experiment{"slip",
                        "estimation with slipping wheels, frames late, lost and wrong",
                        kEstimationSeed,
                        kRuns,
                        {}};
  for (const int ticks_per_frame : {2, 1}) {
    for (const std::string& trajectory : kFive) {
      ExperimentCase each{fmt::format("{}, {} Hz", trajectory, 50 / ticks_per_frame),
                          slow_inner(trajectory),
                          {EstimatorKind::kFusion, EstimatorKind::kEkf, EstimatorKind::kEncoders,
                           EstimatorKind::kVision}};
      each.scenario.vision.ticks_per_frame = ticks_per_frame;
      experiment.cases.push_back(each);
      if (ticks_per_frame == 1) continue;
      each.estimators = {EstimatorKind::kFusionNoRecovery};
      experiment.cases.push_back(each);
    }
  }
  return experiment;
}

Experiment tracking() {
  Experiment experiment{"tracking",
                        "the closed loop with four kinds of feedback, two inner rates",
                        kTrackingSeed,
                        kRuns,
                        {}};
  for (const int inner_steps : {1, 4}) {
    for (const std::string& trajectory : kFive) {
      Scenario each = scenario(trajectory);
      each.control.inner_steps = inner_steps;
      append(experiment.cases,
             driven_by({EstimatorKind::kTruth, EstimatorKind::kEncoders, EstimatorKind::kFusion,
                        EstimatorKind::kVision},
                       fmt::format("{}, {} Hz", trajectory, 50 * inner_steps), each));
    }
  }
  return experiment;
}

Experiment command() {
  Experiment experiment{"command",
                        "error to the raw command: filter, preview, exact nominal",
                        kTrackingSeed,
                        kRuns,
                        {}};
  const LoopParameters outer = ControlParameters{}.outer;
  const double lag_s = 2.0 * outer.filter_damping / outer.filter_bandwidth_radps;
  const std::vector<std::pair<std::string, NominalSettings>> ways = {
      {"filtered", {NominalKind::kFiltered, 0.0, {}}},
      {"preview 0.165 s", {NominalKind::kFiltered, lag_s - 0.5 * ControlParameters{}.tick_s, {}}},
      {"preview 0.185 s", {NominalKind::kFiltered, lag_s + 0.5 * ControlParameters{}.tick_s, {}}},
      {"exact nominal", {NominalKind::kExact, 0.0, {}}}};
  for (const auto& [way, nominal] : ways) {
    for (const std::string& trajectory : kFive) {
      Scenario each = scenario(trajectory);
      each.nominal = nominal;
      append(experiment.cases, driven_by({EstimatorKind::kFusion, EstimatorKind::kEncoders},
                                         fmt::format("{}, {}", trajectory, way), each));
    }
  }
  return experiment;
}

Experiment delay() {
  Experiment experiment{
      "delay", "vision alone and fusion against the delay of the frames", kVisionSeed, kRuns, {}};
  constexpr double kDelays_s[][2] = {{0.0, 0.04},  {0.06, 0.10}, {0.08, 0.12}, {0.10, 0.14},
                                     {0.12, 0.16}, {0.14, 0.18}, {0.16, 0.20}, {0.20, 0.24}};
  for (const double outliers : {0.0, 0.05}) {
    for (const auto& range_s : kDelays_s) {
      Scenario each = slow_inner("square");
      each.vision.min_delay_s = range_s[0];
      each.vision.max_delay_s = range_s[1];
      each.vision.outliers = outliers;
      append(experiment.cases,
             driven_by({EstimatorKind::kVision, EstimatorKind::kFusion},
                       fmt::format("{:.0f}-{:.0f} ms, {:.0f} % outliers", 1e3 * range_s[0],
                                   1e3 * range_s[1], 100.0 * outliers),
                       each, 0.04));
    }
  }
  return experiment;
}

Experiment blackout() {
  Experiment experiment{
      "blackout", "vision alone and fusion when the camera sees nothing", kVisionSeed, kRuns, {}};
  const std::vector<EstimatorKind> drivers = {EstimatorKind::kVision, EstimatorKind::kFusion};
  Scenario bursts = slow_inner("square");
  bursts.vision.burst_loss = BurstLoss{};
  append(experiment.cases, driven_by(drivers, "bursts of 0.4 s, 10 %", bursts, 0.04));
  for (const double length_s : {0.5, 1.0, 2.0, 4.0}) {
    Scenario each = slow_inner("square");
    each.vision.blackout = Blackout{8.0, 8.0 + length_s};
    append(experiment.cases, driven_by(drivers, fmt::format("{} s at 8 s", length_s), each, 0.04));
  }
  return experiment;
}

Experiment shaping() {
  Experiment experiment{
      "shaping", "a step of 1 m, 0.5 m, 1 rad through three command filters", kTrackingSeed, 1, {}};
  Scenario fast = slow_inner("step");
  fast.encoders.kind = EncoderKind::kPerfect;
  Scenario slow = fast;
  slow.control.outer.filter_bandwidth_radps = 3.0;
  Scenario varying = fast;
  varying.nominal.kind = NominalKind::kShaped;
  // The first is shown as it is, without the clip of the body rates that hides what it asks for.
  fast.robot.max_speed_mps = 1e6;
  fast.robot.max_turn_rate_radps = 1e6;
  experiment.cases = {{"bandwidth 8 rad/s", fast, {EstimatorKind::kTruth}},
                      {"bandwidth 3 rad/s", slow, {EstimatorKind::kTruth}},
                      {"time-varying bandwidth", varying, {EstimatorKind::kTruth}}};
  return experiment;
}

Experiment faults() {
  Experiment experiment{"faults",
                        "cable drag and kidnapping, with fusion and encoders alone",
                        kTrackingSeed,
                        kRuns,
                        {}};
  const std::vector<EstimatorKind> drivers = {EstimatorKind::kFusion, EstimatorKind::kEncoders};
  Scenario cable = scenario("square-turning");
  cable.faults.cable = CableDrag{};
  append(experiment.cases, driven_by(drivers, "cable drag", cable));
  Scenario carried = scenario("circle");
  carried.faults.kidnapping = Kidnapping{8.0, {0.3, -0.2, 0.6}};
  append(experiment.cases, driven_by(drivers, "carried 0.36 m away at 8 s", carried));
  return experiment;
}

}  // namespace

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all = {
      of_the_paper("e1", "square with rotation: fusion, encoders alone, vision alone",
                   {"square-turning"}),
      of_the_paper("e2", "square with fixed heading: fusion, encoders alone, vision alone",
                   {"square"}),
      of_the_paper("e3", "circle from rest: fusion, encoders alone, vision alone", {"circle"}),
      of_the_paper("e4", "roses of three and eight petals: fusion, encoders alone, vision alone",
                   {"rose3", "rose4"}),
      of_the_paper("e5", "all five trajectories: fusion, encoders alone, vision alone", kFive),
      race("e6", "robot race between four corners: what odometry loses",
           {EstimatorKind::kTruth, EstimatorKind::kEncoders}),
      race("e7", "robot race in good and bad light: EKF with the variance of each frame",
           {EstimatorKind::kRaceEkf, EstimatorKind::kRaceEkfOneNoise, EstimatorKind::kEncoders,
            EstimatorKind::kVision}),
      follow(),
      matched(),
      slip(),
      tracking(),
      command(),
      delay(),
      blackout(),
      shaping(),
      faults(),
  };
  return all;
}

const Experiment* find_experiment(const std::string& name) {
  const auto& all = experiments();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Experiment& e) { return e.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace nadir::control_client
