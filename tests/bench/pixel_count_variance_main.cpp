// pixel_count_variance: how the errors of two-marker robots grow as fewer pixels show their marks,
// and what is published of it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "calibration/noise_file.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/detector_noise.h"
#include "tests/bench/json_file.h"
#include "tests/bench/noise_figure.h"

namespace {

using nadir::bench::CountNoise;
using nadir::bench::NoiseStudy;
using nadir::bench::PoseVariance;
using nadir::vision::Scene;
using nadir::vision::SceneSensor;

constexpr double kLeastPixels = 5.0;
constexpr double kMostPixels = 200.0;
// Found in at least this share, from the first number of pixels to the second.
constexpr double kFarthestPixels = 8.0;
constexpr double kFarPixels = 20.0;
constexpr double kGoalFound = 0.99;

struct Options {
  std::string json_file;
  std::string svg_file;
  int frames = 150;
  int counts = 14;
};

std::filesystem::path data(const char* name) {
  return std::filesystem::path(NADIR_DATA_DIR) / name;
}

/// The same scene seen by a sensor with three colours in each pixel and by one with a mosaic.
std::vector<NoiseStudy> study(const Options& options) {
  Scene full = nadir::vision::load_scene(data("scenes/pair_far.yaml"));
  Scene mosaic = full;
  mosaic.sensor.mosaic = SceneSensor::Mosaic::kRggb;
  const auto counts = nadir::bench::in_equal_ratios(kLeastPixels, kMostPixels, options.counts);
  const auto run = [&](const char* sensor, const Scene& scene) {
    return nadir::bench::study_detector_noise(sensor, scene, counts, options.frames,
                                              data("noise/goncalves2008.yaml"));
  };
  auto second = std::async(std::launch::async, run, "Bayer sensor", std::cref(mosaic));
  std::vector<NoiseStudy> studies{run("three colours a pixel", full)};
  studies.push_back(second.get());
  return studies;
}

void print(const NoiseStudy& study) {
  fmt::print("{}\n{:>7} {:>7} {:>7} {:>8} {:>8} {:>6} {:>8} {:>9} {:>9}   {:>9} {:>9}",
             study.sensor, "area", "pixels", "robots", "found", "aligned", "false", "px2",
             "place_m2", "head_rad2", "detector", "detector");
  for (const char* quantity : {"place ", "head. ", "NEES "}) {
    fmt::print("  {}", quantity);
    for (const char* law : nadir::bench::kVarianceLaws) fmt::print(" {:>9}", law);
  }
  fmt::print("\n");
  for (const CountNoise& c : study.counts) {
    fmt::print(
        "{:>7.1f} {:>7.1f} {:>7} {:>8.4f} {:>8} {:>6} {:>8.6f} {:>9.2e} {:>9.2e}   {:>9.2e} "
        "{:>9.2e}",
        c.expected_pixels, c.pixels, c.robots, c.found_share(), c.aligned, c.false_robots,
        c.place_px2(), c.measured.place_m2, c.measured.heading_rad2, c.measured_detector.place_m2,
        c.measured_detector.heading_rad2);
    fmt::print("        ");
    for (const PoseVariance& law : c.published) fmt::print(" {:>9.2e}", law.place_m2);
    fmt::print("        ");
    for (const PoseVariance& law : c.published) fmt::print(" {:>9.2e}", law.heading_rad2);
    fmt::print("       ");
    for (const double nees : c.nees) fmt::print(" {:>9.2g}", nees);
    fmt::print("\n");
  }
  fmt::print("found with {:g} to {:g} pixels a mark: {:.4f} (goal {})\n\n", kFarthestPixels,
             kFarPixels, study.found_share(kFarthestPixels, kFarPixels), kGoalFound);
}

void print(const nadir::calibration::TableVariance& papers) {
  fmt::print(
      "papers' tables (marks 40 mm apart)\n{:>7} {:>9} {:>9}  heading_rad2 by class of the outer "
      "mark\n",
      "from_px", "x_m2", "y_m2");
  for (const auto& each : papers.classes) {
    fmt::print("{:>7} {:>9.2e} {:>9.2e} ", each.from_pixels, each.x_m2, each.y_m2);
    for (const double heading_rad2 : each.heading_rad2) fmt::print(" {:>8.1e}", heading_rad2);
    fmt::print("\n");
  }
  fmt::print("\n");
}

nlohmann::json json(const NoiseStudy& study) {
  nlohmann::json counts = nlohmann::json::array();
  for (const CountNoise& c : study.counts) {
    nlohmann::json published;
    for (std::size_t i = 0; i < c.published.size(); ++i) {
      published[nadir::bench::kVarianceLaws[i]] = {{"place_m2", c.published[i].place_m2},
                                                   {"heading_rad2", c.published[i].heading_rad2},
                                                   {"nees", c.nees[i]}};
    }
    counts.push_back({{"expected_pixels", c.expected_pixels},
                      {"pixels", c.pixels},
                      {"pixels_per_metre", c.pixels_per_metre},
                      {"robots", c.robots},
                      {"found", c.found},
                      {"aligned", c.aligned},
                      {"false_robots", c.false_robots},
                      {"x_m2", c.x_m2},
                      {"y_m2", c.y_m2},
                      {"place_px2", c.place_px2()},
                      {"heading_rad2", c.measured.heading_rad2},
                      {"detector_place_m2", c.measured_detector.place_m2},
                      {"detector_heading_rad2", c.measured_detector.heading_rad2},
                      {"published", published}});
  }
  return {{"sensor", study.sensor},
          {"found_share_8_to_20_pixels", study.found_share(kFarthestPixels, kFarPixels)},
          {"counts", counts}};
}

void run(const Options& options) {
  const std::vector<NoiseStudy> studies = study(options);
  const auto noise =
      nadir::calibration::load_pixel_count_variance(data("noise/goncalves2008.yaml"));
  const auto& papers = std::get<nadir::calibration::TableVariance>(noise.law());
  fmt::print(
      "Error of two-marker robots against pixels a mark: mean squared error per axis and of the "
      "heading, aligned\nand as the detector measures them; mean published variance of the place "
      "(per axis) and of the heading;\nNEES, each by fisher, law, table (of the aligned poses) and "
      "pixels (of the detector's)\n\n");
  nlohmann::json all = nlohmann::json::array();
  for (const NoiseStudy& each : studies) {
    print(each);
    all.push_back(json(each));
  }
  print(papers);
  nadir::bench::write_json_file(
      {{"benchmark", "pixel_count_variance"}, {"goal_found_share", kGoalFound}, {"studies", all}},
      options.json_file);
  if (options.svg_file.empty()) return;
  const nadir::vision::MarkerLayout layout =
      nadir::vision::load_marker_layout(data("layouts/pair.yaml"));
  std::ofstream svg(options.svg_file);
  svg << nadir::bench::noise_figure(studies, papers, layout.outer.front().position_robot_m.norm());
  if (!svg.flush()) throw std::runtime_error("cannot write " + options.svg_file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Errors of two-marker robots against the pixels of a mark, measured and published.",
               "pixel_count_variance");
  app.footer("Example: pixel_count_variance --svg variance.svg --json variance.json");
  app.add_option("--json", options.json_file, "write the figures to this file too");
  app.add_option("--svg", options.svg_file, "draw them");
  app.add_option("--frames", options.frames, "for each number of pixels and sensor, 6 robots each")
      ->check(CLI::Range(1, 100000));
  app.add_option("--counts", options.counts, "numbers of pixels, 8 to 200")
      ->check(CLI::Range(2, 200));
  return nadir::bench::bench_main(argc, argv, app, [&options] { run(options); });
}
