#include "control_client/differential/differential_cases.h"

#include <algorithm>
#include <cmath>

#include "control_client/path_trajectories.h"
#include "fusion/magnetic_heading.h"

namespace nadir::control_client {
namespace {

constexpr double kSpeed_mps = 0.1;  // S1's, for which its gains hold
constexpr double kKick_rad = 0.5;
constexpr double kSettled_m = 0.05;
const Eigen::Vector2d kIron(0.6, 1.2);  // shares of the earth's horizontal field

DifferentialScenario scenario(const TrajectoryPtr& path, HeadingFrom heading_from) {
  DifferentialScenario s;
  s.path = path;
  s.heading_from = heading_from;
  s.filter.gate_nis = 0.0;  // S1's filter believes everything
  return s;
}

// The filter's noise is that of its sensors, and it gates.
fusion::HeadingFilterSettings matched(const InertialErrors& errors) {
  fusion::HeadingFilterSettings settings;
  settings.gyro_variance_rad2ps2 = errors.gyro_radps * errors.gyro_radps;
  settings.bias_walk_rad2ps3 = errors.bias_walk_radps * errors.bias_walk_radps;
  return settings;
}

DecentralisedSettings weighted(double side) {
  DecentralisedSettings settings;
  settings.gains = closed_form_gains({.ahead = 1.0, .side = side}, kSpeed_mps);
  return settings;
}

// Farthest outside of the square; inside it is 0.
double outside_m(const fusion::PlanarPose& pose, double half_side_m) {
  return std::max(0.0, std::max(std::abs(pose.x_m), std::abs(pose.y_m)) - half_side_m);
}

// When it came back for good, counted from the kick.
double settled_s(const std::vector<DifferentialTick>& ticks, const Kick& kick, double until_s) {
  double last_s = kick.begin_s;
  for (const DifferentialTick& tick : ticks) {
    if (tick.time_s < kick.begin_s || tick.time_s > until_s) continue;
    const double off_m = (tick.truth.position_m() - tick.reference.pose.position_m()).norm();
    if (off_m > kSettled_m) last_s = tick.time_s;
  }
  return last_s - kick.begin_s;
}

}  // namespace

std::vector<DifferentialCase> l_shape_cases() {
  const TrajectoryPtr path = l_shapes_trajectory();
  std::vector<DifferentialCase> cases;
  const auto add = [&](const char* name, const char* label,
                       HeadingFrom heading_from) -> DifferentialScenario& {
    cases.push_back({name, label, scenario(path, heading_from), 0.0});
    cases.back().scenario.kick.turn_rad = kKick_rad;
    return cases.back().scenario;
  };
  add("truth", "true heading", HeadingFrom::kTruth);
  add("filter", "filter", HeadingFrom::kFilter);
  add("filter-unfelt", "filter, gyro misses the kick", HeadingFrom::kFilter).kick.gyro_feels_it =
      false;
  add("wheels", "wheels alone", HeadingFrom::kWheels);
  add("klancar", "filter, nonlinear controller", HeadingFrom::kFilter).controller =
      KlancarSettings{};
  DifferentialScenario& matched_noise =
      add("matched", "filter, its noise that of the sensors", HeadingFrom::kFilter);
  matched_noise.filter = matched(matched_noise.errors);
  add("iron", "filter, iron near for 10 s", HeadingFrom::kFilter).iron.disturbance_world = kIron;
  DifferentialScenario& gated =
      add("iron-gated", "the same, noise of the sensors, gates", HeadingFrom::kFilter);
  gated.iron.disturbance_world = kIron;
  gated.filter = matched(gated.errors);
  gated.field_tolerance = fusion::FieldGate{}.tolerance;
  DifferentialScenario& seen =
      add("vision", "noise of the sensors, headings of a camera", HeadingFrom::kFilter);
  seen.filter = matched(seen.errors);
  seen.vision.period_s = 0.04;
  return cases;
}

std::vector<DifferentialCase> two_circle_cases() {
  const TrajectoryPtr path = s1_circles_trajectory();
  DecentralisedSettings feedback;
  feedback.feeds_turn_rate_forward = false;
  DecentralisedSettings integral = feedback;
  integral.integral_side = 1.5;
  std::vector<DifferentialCase> cases;
  const auto add = [&](const char* name, const char* label, HeadingFrom heading_from,
                       const DecentralisedSettings& controller) {
    cases.push_back({name, label, scenario(path, heading_from), 0.0});
    cases.back().scenario.controller = controller;
  };
  add("feed-forward-truth", "w_r fed forward, true heading", HeadingFrom::kTruth, {});
  add("feed-forward-filter", "w_r fed forward, filter", HeadingFrom::kFilter, {});
  add("feedback-truth", "w_r left to the feedback, true heading", HeadingFrom::kTruth, feedback);
  add("feedback-filter", "w_r left to the feedback, filter", HeadingFrom::kFilter, feedback);
  add("integral-truth", "the same, integral of e2, true heading", HeadingFrom::kTruth, integral);
  return cases;
}

std::vector<DifferentialCase> square_cases() {
  const TrajectoryPtr path = square_along_trajectory();
  std::vector<DifferentialCase> cases;
  for (const int side : {5, 50, 500, 5000}) {
    DifferentialScenario s = scenario(path, HeadingFrom::kTruth);
    s.controller = weighted(side);
    cases.push_back({"q2-" + std::to_string(side), "q2 = " + std::to_string(side), s, 0.5});
  }
  return cases;
}

DifferentialResult run_case(const DifferentialCase& which, std::uint64_t first_seed, int runs) {
  DifferentialResult result{which, {}, {}};
  DifferentialSummary& sum = result.summary;
  double squares_m2 = 0.0;
  double heading_rad2 = 0.0;
  double count = 0.0;
  for (int run = 0; run < runs; ++run) {
    std::vector<DifferentialTick> ticks =
        run_differential(which.scenario, first_seed + static_cast<std::uint64_t>(run));
    double largest_m = 0.0;
    double overshoot_m = 0.0;
    for (const DifferentialTick& tick : ticks) {
      const double off_m = (tick.truth.position_m() - tick.reference.pose.position_m()).norm();
      largest_m = std::max(largest_m, off_m);
      squares_m2 += off_m * off_m;
      heading_rad2 +=
          std::pow(fusion::wrap_angle(tick.estimate.heading_rad - tick.truth.heading_rad), 2);
      count += 1.0;
      if (which.corner_m > 0.0) {
        overshoot_m = std::max(overshoot_m, outside_m(tick.truth, which.corner_m));
      }
    }
    const Eigen::Vector3d last = tracking_error(ticks.back().reference, ticks.back().truth);
    sum.position_max_m += largest_m / runs;
    sum.position_end_m += last.head<2>().norm() / runs;
    sum.side_end_m += std::abs(last.y()) / runs;
    sum.overshoot_m += overshoot_m / runs;
    constexpr double kFirstCorner_s = 15.0;
    sum.settled_s += settled_s(ticks, which.scenario.kick, kFirstCorner_s) / runs;
    if (run == 0) result.example = std::move(ticks);
  }
  sum.runs = runs;
  sum.position_rms_m = std::sqrt(squares_m2 / count);
  sum.heading_rms_rad = std::sqrt(heading_rad2 / count);
  return result;
}

}  // namespace nadir::control_client
