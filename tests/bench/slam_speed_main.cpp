// slam_speed: what mapping costs, against the number of landmarks, beside a textbook's filter.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "fusion/slam/ekf_slam.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/json_file.h"
#include "tests/bench/svg_plot.h"
#include "tests/bench/thread_cpu_clock.h"
#include "tests/fusion/dense_slam.h"

namespace {

using namespace nadir::fusion;

constexpr double kGoal_us = 200.0;  // one sighting, 200 landmarks
constexpr std::array<int, 6> kMaps = {10, 25, 50, 100, 200, 400};
constexpr std::array<int, 3> kInView = {1, 4, 8};
constexpr int kLargestDense = 200;
const Eigen::Matrix2d kNoise = sighting_covariance(0.03, 0.01);

/// Medians of CPU time, microseconds.
struct ScanCost {
  int landmarks = 0;
  int in_view = 0;
  double named_us = 0.0;
  double nameless_us = 0.0;
};
struct MapCost {
  int landmarks = 0;
  double step_us = 0.0;   ///< of odometry
  double dense_us = 0.0;  ///< one sighting, textbook; 0: not measured
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <class Work>
double median_us(int measurements, Work work) {
  std::vector<double> each;
  for (int i = 0; i < measurements; ++i) {
    const double start_us = nadir::bench::thread_cpu_us();
    work(i);
    each.push_back(nadir::bench::thread_cpu_us() - start_us);
  }
  return median(each);
}

/// Landmarks on a grid 2 m apart around the start.
Eigen::Vector2d place_m(int landmark) {
  constexpr int kRow = 20;
  return {2.0 * (landmark % kRow) - 19.0, 2.0 * (landmark / kRow) - 19.0};
}

Sighting sighting_of(const PlanarPose& pose, const Eigen::Vector2d& landmark_m, int name) {
  return {predicted_sighting(pose, landmark_m).seen, kNoise, name};
}

EkfSlam<> mapped(int landmarks) {
  EkfSlam<>::Settings settings;
  settings.most_landmarks = landmarks;
  EkfSlam<> slam(settings);
  slam.start({}, 1e-6 * PoseCovariance::Identity());
  for (int i = 0; i < landmarks; ++i) {
    const Sighting sighting = sighting_of(slam.pose(), place_m(i), i);
    SightingReport report;
    slam.observe({&sighting, 1}, {&report, 1});
  }
  return slam;
}

ScanCost scan_cost(int landmarks, int in_view) {
  constexpr int kMeasurements = 101;
  EkfSlam<> slam = mapped(landmarks);
  std::vector<Sighting> scan(static_cast<std::size_t>(in_view));
  std::vector<SightingReport> reports(scan.size());
  const auto look = [&](int time) {
    slam.predict({{0.1, 0.0, 0.05}, {0.1, 0.0, 0.05}, 0.05, 0.05});
    for (int i = 0; i < in_view; ++i) {
      const int landmark = (7 * time + i) % landmarks;
      scan[static_cast<std::size_t>(i)] =
          sighting_of(slam.pose(), slam.landmark_m(landmark), landmark);
    }
  };
  const double step_us = median_us(kMeasurements, look);
  const auto cost_us = [&](auto observe) {
    const double all_us = median_us(kMeasurements, [&](int time) {
      look(time);
      observe();
      for (const SightingReport& report : reports) {
        if (report.verdict != SightingVerdict::kUsed)
          throw std::runtime_error("a sighting was not used");
      }
    });
    return all_us - step_us;
  };
  const double named_us = cost_us([&] { slam.observe(scan, reports); });
  const double nameless_us = cost_us([&] { slam.observe_nameless(scan, reports); });
  return {landmarks, in_view, named_us, nameless_us};
}

double dense_us(int landmarks) {
  test::DenseSlam dense({}, 1e-6 * PoseCovariance::Identity());
  for (int i = 0; i < landmarks; ++i) {
    dense.observe(i, sighting_of({}, place_m(i), i).measured.vector(), kNoise);
  }
  return median_us(landmarks > 50 ? 5 : 51, [&](int time) {
    const int landmark = time % landmarks;
    dense.observe(landmark, sighting_of({}, place_m(landmark), landmark).measured.vector(), kNoise);
  });
}

MapCost map_cost(int landmarks) {
  EkfSlam<> slam = mapped(landmarks);
  constexpr int kSteps = 100;
  const double steps_us = median_us(101, [&](int) {
    for (int i = 0; i < kSteps; ++i) slam.predict({{0.1, 0.0, 0.05}, {0.1, 0.0, 0.05}, 0.05, 0.05});
  });
  return {landmarks, steps_us / kSteps, landmarks > kLargestDense ? 0.0 : dense_us(landmarks)};
}

// A curve with its name after its end.
nadir::bench::PlotSeries curve(const char* colour, const std::string& label,
                               const std::vector<nadir::bench::PlotPoint>& points) {
  using Kind = nadir::bench::PlotSeries::Kind;
  const nadir::bench::PlotPoint end = points.back();
  return {Kind::kCurve, colour, points, {{label, {1.05 * end.x, 0.85 * end.y}, "start"}}};
}

std::string figure(const std::vector<ScanCost>& scans, const std::vector<MapCost>& maps) {
  nadir::bench::PlotPanel panel{"mapping: cost of what is seen",
                                "landmarks in the map",
                                "CPU time, us",
                                8.0,
                                1500.0,
                                0.1,
                                1e6,
                                {},
                                {}};
  for (const int size : kMaps) panel.x_ticks.push_back(size);
  const std::array<const char*, 3> colours = {"#0b62a4", "#3b8f4a", "#d98a00"};
  for (std::size_t i = 0; i < kInView.size(); ++i) {
    std::vector<nadir::bench::PlotPoint> points;
    for (const ScanCost& each : scans) {
      if (each.in_view == kInView[i]) {
        points.push_back({static_cast<double>(each.landmarks), each.named_us});
      }
    }
    panel.series.push_back(curve(colours[i], fmt::format("{} in view", kInView[i]), points));
  }
  std::vector<nadir::bench::PlotPoint> steps;
  std::vector<nadir::bench::PlotPoint> dense;
  for (const MapCost& each : maps) {
    steps.push_back({static_cast<double>(each.landmarks), each.step_us});
    if (each.dense_us > 0.0) dense.push_back({static_cast<double>(each.landmarks), each.dense_us});
  }
  panel.series.push_back(curve("#777777", "odometry", steps));
  panel.series.push_back(curve("#d1493f", "textbook, 1 in view", dense));
  return nadir::bench::svg_figure({panel}, {"medians of CPU time, names known"});
}

void print(const std::vector<ScanCost>& scans, const std::vector<MapCost>& maps) {
  fmt::print(
      "Mapping landmarks, one thread, medians of CPU time, us (goal: 1 in view of 200 below {})\n",
      kGoal_us);
  fmt::print("{:>9} {:>9} {:>11}", "landmarks", "odometry", "textbook, 1");
  for (const int count : kInView)
    fmt::print(" {:>9} {:>9}", fmt::format("{} seen", count), "nameless");
  fmt::print("\n");
  for (const MapCost& map : maps) {
    fmt::print("{:>9} {:>9.2f} {:>11}", map.landmarks, map.step_us,
               map.dense_us > 0.0 ? fmt::format("{:.0f}", map.dense_us) : "");
    for (const ScanCost& scan : scans) {
      if (scan.landmarks == map.landmarks) {
        fmt::print(" {:>9.1f} {:>9.1f}", scan.named_us, scan.nameless_us);
      }
    }
    fmt::print("\n");
  }
  fmt::print("\n");
}

void run(const std::string& json_file, const std::string& svg_file) {
  std::vector<ScanCost> scans;
  std::vector<MapCost> maps;
  for (const int landmarks : kMaps) {
    maps.push_back(map_cost(landmarks));
    for (const int in_view : kInView) scans.push_back(scan_cost(landmarks, in_view));
  }
  print(scans, maps);
  nlohmann::json scan_list = nlohmann::json::array();
  for (const ScanCost& each : scans) {
    scan_list.push_back({{"landmarks", each.landmarks},
                         {"in_view", each.in_view},
                         {"named_us", each.named_us},
                         {"nameless_us", each.nameless_us}});
  }
  nlohmann::json map_list = nlohmann::json::array();
  for (const MapCost& each : maps) {
    map_list.push_back({{"landmarks", each.landmarks}, {"odometry_us", each.step_us}});
    if (each.dense_us > 0.0) map_list.back()["textbook_us"] = each.dense_us;
  }
  nadir::bench::write_json_file({{"benchmark", "slam_speed"},
                                 {"goal_us_1_in_view_of_200", kGoal_us},
                                 {"scans", scan_list},
                                 {"maps", map_list}},
                                json_file);
  if (svg_file.empty()) return;
  std::ofstream svg(svg_file);
  svg << figure(scans, maps);
  if (!svg.flush()) throw std::runtime_error("cannot write " + svg_file);
}

}  // namespace

int main(int argc, char** argv) {
  std::string json_file;
  std::string svg_file;
  CLI::App app("CPU time of mapping against the number of landmarks.", "slam_speed");
  app.footer("Example: slam_speed --svg slam.svg --json slam.json");
  app.add_option("--json", json_file, "write the figures to this file too");
  app.add_option("--svg", svg_file, "draw them");
  return nadir::bench::bench_main(argc, argv, app, [&] { run(json_file, svg_file); });
}
