// fusion_speed: what the onboard estimate costs, beside a textbook's filter with dynamic matrices.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fusion/delayed_fusion.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/json_file.h"
#include "tests/bench/thread_cpu_clock.h"
#include "tests/fusion/textbook_filter.h"

namespace {

using namespace nadir::fusion;
using namespace std::chrono_literals;

constexpr double kGoalStep_us = 1.0;
constexpr double kGoalReplay_us = 20.0;
constexpr double kGoalMemory_MB = 16.0;
constexpr int kMeasurements = 31;

const Eigen::Matrix3d kRateCovariance = Eigen::Vector3d(6e-4, 6e-4, 0.0612).asDiagonal();
const PoseCovariance kPoseCovariance = Eigen::Vector3d(4e-6, 4e-6, 2e-3).asDiagonal();
constexpr BodyRates kRates{0.2, 0.1, 0.5};

volatile double g_sink = 0.0;  // so that nothing is optimised away

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + kMeasurements / 2, values.end());
  return values[kMeasurements / 2];
}

/// Median CPU time of one call of `work`, which is called `calls` times a measurement.
template <class Work>
double median_us(int calls, Work work) {
  std::vector<double> each;
  for (int i = 0; i < kMeasurements; ++i) {
    const double start_us = nadir::bench::thread_cpu_us();
    for (int k = 0; k < calls; ++k) work();
    each.push_back((nadir::bench::thread_cpu_us() - start_us) / calls);
  }
  return median(each);
}

/// One prediction and one correction by a pose that is accepted.
template <class Linearization>
double step_us() {
  PoseFilter<Linearization> filter;
  filter.start({0.1, 0.2, 0.3}, kPoseCovariance);
  const double time_us = median_us(20000, [&] {
    filter.predict({kRates, kRates, 0.005, 0.005});
    PlanarPose measured = filter.state().pose;
    measured.x_m += 1e-4;
    g_sink = g_sink + filter.correct(measured, kPoseCovariance).nis;
  });
  return time_us;
}

double textbook_step_us() {
  test::TextbookFilter filter(Eigen::Vector3d(0.1, 0.2, 0.3), kPoseCovariance);
  const Eigen::VectorXd rates = kRates.vector();
  const Eigen::MatrixXd q = kRateCovariance;
  const Eigen::MatrixXd r = kPoseCovariance;
  return median_us(20000, [&] {
    filter.predict(rates, q, 0.005);
    Eigen::VectorXd measured = filter.x();
    measured[0] += 1e-4;
    filter.correct(measured, r);
    g_sink = g_sink + filter.p()(0, 0);
  });
}

VisionPose pose_from(const Estimate& estimate, std::uint64_t frame) {
  return {0, 0, frame, estimate.time - 1ns, estimate.pose, kPoseCovariance};
}

/// A pose 150 ms late, with 200 Hz odometry and other poses at 50 Hz in the time it is late: insert
/// it and compute the history again. Calls in which it is not accepted would be an error.
template <class Linearization>
double replay_us() {
  using Fusion = DelayedFusion<Linearization>;
  Fusion fusion;
  fusion.start(100s, {0.1, 0.2, 0.3}, kPoseCovariance);
  typename Fusion::Odometry sample{100s, 100s + 5ms, kRates, {}};
  std::uint64_t frame = 0;
  std::vector<double> each;
  for (int i = 0; i < 200 * kMeasurements; ++i) {
    fusion.add_odometry(sample);
    sample.from += 5ms;
    sample.to += 5ms;
    if (i < 400 || i % 4 != 0) continue;
    const VisionPose late = pose_from(*fusion.estimate_at(fusion.now() - 150ms + 2500us), ++frame);
    const double start_us = nadir::bench::thread_cpu_us();
    const Correction result = fusion.add_pose(late);
    each.push_back(nadir::bench::thread_cpu_us() - start_us);
    if (result.verdict != PoseVerdict::kAccepted) throw std::runtime_error("pose not accepted");
  }
  std::nth_element(each.begin(), each.begin() + static_cast<std::ptrdiff_t>(each.size() / 2),
                   each.end());
  return each[each.size() / 2];
}

/// The textbook's way to the same: its filter's copy of 150 ms ago, then 30 steps of odometry and
/// the 8 poses in them.
double textbook_replay_us() {
  const test::TextbookFilter start(Eigen::Vector3d(0.1, 0.2, 0.3), kPoseCovariance);
  const Eigen::VectorXd rates = kRates.vector();
  const Eigen::MatrixXd q = kRateCovariance;
  const Eigen::MatrixXd r = kPoseCovariance;
  return median_us(500, [&] {
    test::TextbookFilter filter = start;
    for (int i = 0; i < 30; ++i) {
      filter.predict(rates, q, 0.005);
      if (i % 4 == 0) filter.correct(filter.x(), r);
    }
    g_sink = g_sink + filter.p()(0, 0);
  });
}

// A second of history, and 50 poses.
constexpr HistorySize kSecondAt200Hz{20, 11, 50};
constexpr HistorySize kSecondAt50Hz{10, 6, 50};

template <class Linearization>
double memory_of_thousand_robots_MB(const HistorySize& size) {
  typename DelayedFusion<Linearization>::Settings settings;
  settings.history = size;
  return 1e-6 * 1000.0 * static_cast<double>(DelayedFusion<Linearization>(settings).memory_bytes());
}

void run(const std::string& json_file) {
  const double estimate_us = step_us<AboutEstimate>();
  const double nominal_us = step_us<AlongNominal>();
  const double textbook_us = textbook_step_us();
  const double replay_estimate_us = replay_us<AboutEstimate>();
  const double replay_nominal_us = replay_us<AlongNominal>();
  const double replay_textbook_us = textbook_replay_us();
  const double memory_estimate = memory_of_thousand_robots_MB<AboutEstimate>(kSecondAt200Hz);
  const double memory_nominal = memory_of_thousand_robots_MB<AlongNominal>(kSecondAt200Hz);
  const double small_estimate = memory_of_thousand_robots_MB<AboutEstimate>(kSecondAt50Hz);
  const double small_nominal = memory_of_thousand_robots_MB<AlongNominal>(kSecondAt50Hz);
  const auto row = [](const char* what, double estimate, double nominal, double textbook,
                      double goal) {
    fmt::print("{:<44} {:>9.3f} {:>9.3f} {:>9.3f} {:>7}\n", what, estimate, nominal, textbook,
               goal);
  };
  fmt::print("Onboard estimate, one thread, medians of CPU time\n{:<44} {:>9} {:>9} {:>9} {:>7}\n",
             "", "estimate", "nominal", "textbook", "goal");
  row("predict and update, us", estimate_us, nominal_us, textbook_us, kGoalStep_us);
  row("pose 150 ms late at 200 Hz, us", replay_estimate_us, replay_nominal_us, replay_textbook_us,
      kGoalReplay_us);
  const auto memory_row = [](int rate_hz, double estimate, double nominal) {
    fmt::print("1000 robots, a second at {:>3} Hz, MB {:<10} {:>9.1f} {:>9.1f} {:>9} {:>7}\n",
               rate_hz, "", estimate, nominal, "", kGoalMemory_MB);
  };
  memory_row(200, memory_estimate, memory_nominal);
  memory_row(50, small_estimate, small_nominal);
  fmt::print(
      "estimate, nominal: what covariances are linearised about; textbook: the same filter with\n"
      "matrices of dynamic size, its replay without history, search and reports\n\n");
  nadir::bench::write_json_file(
      {{"benchmark", "fusion_speed"},
       {"goal_step_us", kGoalStep_us},
       {"goal_replay_us", kGoalReplay_us},
       {"goal_memory_mb", kGoalMemory_MB},
       {"step_us", {{"estimate", estimate_us}, {"nominal", nominal_us}, {"textbook", textbook_us}}},
       {"replay_150_ms_us",
        {{"estimate", replay_estimate_us},
         {"nominal", replay_nominal_us},
         {"textbook", replay_textbook_us}}},
       {"memory_1000_robots_200_hz_mb",
        {{"estimate", memory_estimate}, {"nominal", memory_nominal}}},
       {"memory_1000_robots_50_hz_mb", {{"estimate", small_estimate}, {"nominal", small_nominal}}}},
      json_file);
}

}  // namespace

int main(int argc, char** argv) {
  std::string json_file;
  CLI::App app("CPU time and memory of the onboard estimate beside a textbook's filter.",
               "fusion_speed");
  app.footer("Example: fusion_speed --json speed.json");
  app.add_option("--json", json_file, "write the figures to this file too");
  return nadir::bench::bench_main(argc, argv, app, [&json_file] { run(json_file); });
}
