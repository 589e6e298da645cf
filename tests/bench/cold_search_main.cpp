// cold_search: what finding all robots in a frame costs, beside reading the frame.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <string>
#include <vector>

#include "tests/bench/bench_program.h"
#include "tests/bench/cold_search.h"
#include "tests/bench/json_file.h"

namespace {

using nadir::bench::Cost;
using nadir::bench::SearchCase;
using nadir::bench::SearchCosts;

struct Options {
  std::string json_file;
  std::string only;
  int measurements = 120;
};

// At most this many readings: at 1280x1024 and at 2560x2048.
constexpr double kGoalPerReading = 2.5;
constexpr double kGoalPerReadingLarge = 1.0;

std::vector<SearchCase> search_cases() {
  const std::filesystem::path folder = std::filesystem::path(NADIR_DATA_DIR) / "scenes";
  std::vector<SearchCase> cases;
  for (const char* name :
       {"league_even", "league_bayer", "league_dim_warm", "league_shadow", "pair_even"}) {
    cases.push_back({name, nadir::vision::load_scene(folder / fmt::format("{}.yaml", name))});
  }
  cases.push_back({"league_even_x2", nadir::bench::enlarged(cases.front().scene, 2)});
  return cases;
}

std::string row(const SearchCosts& costs) {
  return fmt::format(
      "{:<16} {:>4}x{:<4} {:>8.0f} {:>8.0f} {:>8.0f} {:>8.0f} {:>8.2f} {:>8.1f} {:>6.2f}/{} "
      "{:>9.1f} {:>6.2f}/{}\n",
      costs.name, costs.width_px, costs.height_px, costs.read_in_order.median_us,
      costs.read_two_streams.median_us, costs.nadir.median_us, costs.opencv.median_us,
      costs.nadir_per_reading(), costs.opencv_per_reading(), costs.nadir_robots, costs.robots,
      costs.nadir_rejected, costs.opencv_robots, costs.robots);
}

void print(const std::vector<SearchCosts>& all) {
  fmt::print(
      "Search of a whole frame for robots, poses included: one thread, medians of CPU time, "
      "microseconds\n"
      "{:<16} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n"
      "{:<16} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n",
      "", "", "read in", "read in", "", "", "nadir /", "OpenCV /", "robots,", "turned", "robots,",
      "scene", "image", "order", "2 halves", "nadir", "OpenCV", "reading", "reading", "nadir",
      "down", "OpenCV");
  for (const SearchCosts& costs : all) fmt::print("{}", row(costs));
  fmt::print(
      "reading: the faster of the two; goal: nadir / reading at most {} at 1280x1024, {} at "
      "2560x2048\n"
      "Each variant's next frame is none that the cache still holds ({} measurements each: "
      "nadir and reading by turns, then OpenCV).\n"
      "OpenCV's thresholds were made for the even light.\n\n",
      kGoalPerReading, kGoalPerReadingLarge, all.front().measurements);
}

nlohmann::json json(const Cost& cost) {
  return {{"median_us", cost.median_us},
          {"quarter_us", cost.quarter_us},
          {"three_quarters_us", cost.three_quarters_us}};
}

nlohmann::json json(const SearchCosts& costs) {
  return {{"scene", costs.name},
          {"width_px", costs.width_px},
          {"height_px", costs.height_px},
          {"robots", costs.robots},
          {"buffers", costs.buffers},
          {"measurements", costs.measurements},
          {"read_in_order", json(costs.read_in_order)},
          {"read_two_streams", json(costs.read_two_streams)},
          {"nadir", json(costs.nadir)},
          {"opencv", json(costs.opencv)},
          {"nadir_per_reading", costs.nadir_per_reading()},
          {"opencv_per_reading", costs.opencv_per_reading()},
          {"nadir_robots", costs.nadir_robots},
          {"nadir_rejected", costs.nadir_rejected},
          {"opencv_robots", costs.opencv_robots}};
}

void run(const Options& options) {
  cv::setNumThreads(1);
  std::vector<SearchCosts> all;
  for (const SearchCase& search_case : search_cases()) {
    if (!options.only.empty() && search_case.name != options.only) continue;
    all.push_back(nadir::bench::measure_cold_search(search_case, options.measurements));
  }
  if (all.empty()) throw std::runtime_error("no scene is called " + options.only);
  print(all);
  nlohmann::json cases = nlohmann::json::array();
  for (const SearchCosts& costs : all) cases.push_back(json(costs));
  nadir::bench::write_json_file({{"benchmark", "cold_search"},
                                 {"goal_per_reading_1280x1024", kGoalPerReading},
                                 {"goal_per_reading_2560x2048", kGoalPerReadingLarge},
                                 {"cases", cases}},
                                options.json_file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("CPU time of a full-frame search beside reading the frame and beside OpenCV.",
               "cold_search");
  app.footer("Example: cold_search --scene league_even --json search.json");
  app.add_option("--json", options.json_file, "write the figures to this file too");
  app.add_option("--scene", options.only, "only this one");
  app.add_option("--measurements", options.measurements, "of each variant")
      ->check(CLI::Range(1, 1000000));
  return nadir::bench::bench_main(argc, argv, app, [&options] { run(options); });
}
