// alignment: poses by alignment beside the Cramer-Rao bound, in several lights and with spoiled
// frames.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/alignment_study.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/cold_search.h"
#include "tests/bench/json_file.h"
#include "tests/support/following_study.h"

namespace {

using nadir::bench::AlignmentCase;
using nadir::bench::AlignmentStudy;

struct Options {
  std::string json_file;
  std::string only;
  int frames = 200;
  double guess_px = 0.3;
  bool speed = false;
  bool following = false;
  nadir::tracker::AlignmentSettings settings;
};

void print_header() {
  fmt::print(
      "{:<15} {:>6} {:>5} {:>7} {:>7} {:>6} {:>6} {:>7} {:>7} {:>6} {:>6} {:>7} {:>7} {:>5} {:>7} "
      "{:>3} {:>4} {:>5} {:>6} {:>5} {:>6}\n",
      "case", "robots", "lost", "pos_px", "bound", "ratio", "median", "head_dg", "bound", "ratio",
      "median", "bias_u", "bias_v", "NEES", "worst", ">6s", "iter", "us", "blur", "read", "shot");
}

void print(const AlignmentCase& which, const AlignmentStudy& s) {
  fmt::print(
      "{:<15} {:>6} {:>5} {:>7.4f} {:>7.4f} {:>6.2f} {:>6.2f} {:>7.4f} {:>7.4f} {:>6.2f} {:>6.2f} "
      "{:>7.4f} {:>7.4f} {:>5.2f} {:>7.1f} {:>3} {:>4.1f} {:>5.1f} {:>6.3f} {:>5.2f} {:>6.4f}\n",
      which.name, s.robots, s.lost, s.position_rms_px, s.position_bound_px, s.position_ratio(),
      s.position_median_ratio, s.heading_rms_deg, s.heading_bound_deg, s.heading_ratio(),
      s.heading_median_ratio, s.bias_px.x(), s.bias_px.y(), s.nees, s.worst_nees, s.overconfident,
      s.iterations, s.microseconds, s.blur_px, s.read, s.shot);
  std::fflush(stdout);
}

nlohmann::json json(const AlignmentCase& which, const AlignmentStudy& s) {
  return {{"case", which.name},
          {"robots", s.robots},
          {"lost", s.lost},
          {"position_rms_px", s.position_rms_px},
          {"position_bound_px", s.position_bound_px},
          {"position_median_ratio", s.position_median_ratio},
          {"heading_rms_deg", s.heading_rms_deg},
          {"heading_bound_deg", s.heading_bound_deg},
          {"heading_median_ratio", s.heading_median_ratio},
          {"bias_px", {s.bias_px.x(), s.bias_px.y()}},
          {"nees", s.nees},
          {"beyond_six_sigma", s.overconfident},
          {"iterations", s.iterations},
          {"robot_us", s.microseconds}};
}

// Robots that stand, so that they are followed: frame to poses, newcomers' slice of search
// included.
std::vector<nadir::bench::SearchCase> speed_cases() {
  const std::filesystem::path folder = std::filesystem::path(NADIR_DATA_DIR) / "scenes";
  const auto standing = [&](const std::string& name) {
    nadir::vision::Scene scene = nadir::vision::load_scene(folder / (name + ".yaml"));
    for (nadir::vision::RandomRobots& robots : scene.random_robots) {
      robots.redraw_every_frame = false;
    }
    return scene;
  };
  const nadir::vision::Scene league = standing("league_even");
  // The same robots, as large in pixels, under a camera that shows four times the floor.
  nadir::vision::Scene wide = nadir::bench::enlarged(league, 2);
  wide.camera.height_m += league.camera.height_m - league.layouts.front().height_m;
  nadir::vision::Scene hundred = standing("pair_even");
  hundred.camera = league.camera;
  hundred.random_robots.front().count = 100;
  const auto followed = [](const char* name, const nadir::vision::Scene& scene) {
    return nadir::bench::SearchCase{.name = name,
                                    .scene = scene,
                                    .source = nadir::tracker::PoseSource::kAlignment,
                                    .beside_opencv = false};
  };
  return {followed("12 league", league),
          followed("12 league x2", nadir::bench::enlarged(league, 2)),
          followed("12 league wide", wide), followed("100 pairs", hundred)};
}

nlohmann::json run_speed(const std::string& only) {
  fmt::print("{:<14} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "followed", "image", "read_us", "nadir_us",
             "/ reading", "robots");
  nlohmann::json cases = nlohmann::json::array();
  for (const nadir::bench::SearchCase& which : speed_cases()) {
    if (which.name.find(only) == std::string::npos) continue;
    const nadir::bench::SearchCosts costs = nadir::bench::measure_cold_search(which, 300);
    fmt::print("{:<14} {:>4}x{:<4} {:>9.0f} {:>9.0f} {:>9.2f} {:>4.1f}/{}\n", costs.name,
               costs.width_px, costs.height_px, costs.reading_us(), costs.nadir.median_us,
               costs.nadir_per_reading(), costs.nadir_robots, costs.robots);
    cases.push_back({{"case", costs.name},
                     {"reading_us", costs.reading_us()},
                     {"nadir_us", costs.nadir.median_us},
                     {"robots", costs.nadir_robots}});
  }
  return cases;
}

// Who stays whom: about 3000 robots in frames for each story.
nlohmann::json run_following() {
  using nadir::support::FollowingStory;
  const std::vector<std::pair<const char*, FollowingStory>> stories = {
      {"touching", {.frames = 250}},
      {"crossing", {.frames = 250, .crossing = true}},
      {"crossing, 3 m/s", {.frames = 250, .speed_mps = 3.0, .balls = true, .crossing = true}},
      {"one covered", {.frames = 250, .covers_one_disc = true, .balls = true}},
      {"two covered", {.frames = 250, .covers_two_discs = true}},
      {"clutter, carried", {.frames = 250, .balls = true, .swaps = true}},
      {"taken away", {.frames = 250, .balls = true, .lifts = true}},
      {"all of it",
       {.frames = 250,
        .covers_one_disc = true,
        .covers_two_discs = true,
        .balls = true,
        .swaps = true,
        .lifts = true,
        .crossing = true}}};
  const std::filesystem::path folder = std::filesystem::path(NADIR_DATA_DIR) / "scenes";
  fmt::print("{:<18} {:>7} {:>9} {:>7} {:>6} {:>9} {:>14} {:>9} {:>5} {:>7}\n", "followed",
             "robots", "uncovered", "missed", "wrong", "phantoms", "covered, found", "newcomer",
             "lost", "rms_px");
  nlohmann::json cases = nlohmann::json::array();
  for (const auto& [name, story] : stories) {
    const nadir::support::FollowingStudy study = nadir::support::study_following(
        nadir::vision::load_scene(folder / "league_even.yaml"), story, 17);
    fmt::print("{:<18} {:>7} {:>9} {:>7} {:>6} {:>9} {:>14} {:>9} {:>5} {:>7.4f}\n", name,
               study.robot_frames, study.uncovered, study.missed, study.wrong_ids, study.phantoms,
               study.covered_found, study.slowest_newcomer, study.longest_loss, study.rms_px);
    std::fflush(stdout);
    cases.push_back({{"story", name},
                     {"robots", study.robot_frames},
                     {"missed", study.missed},
                     {"wrong_ids", study.wrong_ids},
                     {"phantoms", study.phantoms},
                     {"frames_to_newcomer", study.slowest_newcomer},
                     {"frames_lost", study.longest_loss}});
  }
  return cases;
}

void run(const Options& options) {
  if (options.following) {
    nadir::bench::write_json_file(
        {{"benchmark", "alignment following"}, {"cases", run_following()}}, options.json_file);
    return;
  }
  if (options.speed) {
    nadir::bench::write_json_file(
        {{"benchmark", "alignment speed"}, {"cases", run_speed(options.only)}}, options.json_file);
    return;
  }
  print_header();
  nlohmann::json cases = nlohmann::json::array();
  for (const AlignmentCase& which : nadir::bench::alignment_cases()) {
    if (which.name.find(options.only) == std::string::npos) continue;
    const AlignmentStudy study =
        nadir::bench::study_alignment(which, options.frames, options.guess_px, options.settings);
    print(which, study);
    cases.push_back(json(which, study));
  }
  nadir::bench::write_json_file(
      {{"benchmark", "alignment"}, {"frames", options.frames}, {"cases", cases}},
      options.json_file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Poses by alignment beside the Cramer-Rao bound.", "alignment");
  app.footer("Example: alignment --case league --frames 200 --json alignment.json");
  app.add_option("--json", options.json_file, "write the figures to this file too");
  app.add_option("--case", options.only, "only cases whose name has this in it");
  app.add_option("--frames", options.frames, "of each case")->check(CLI::Range(1, 1000000));
  app.add_flag("--speed", options.speed, "what following costs, instead");
  app.add_flag("--following", options.following, "who stays whom, instead");
  app.add_option("--guess", options.guess_px, "RMS distance of the guesses from the truth, px");
  app.add_option("--floor", options.settings.floor_px, "error of a disc that nothing tells of, px");
  app.add_option("--huber", options.settings.huber_sigmas, "limit of Huber's weights, sigmas");
  app.add_option("--far", options.settings.far_sigmas, "where a pixel's pull fades, sigmas");
  app.add_option("--rim", options.settings.rim_sigmas, "masked beside the rim, blurs");
  app.add_option("--margin", options.settings.margin_sigmas, "looked at outside of an edge, blurs");
  return nadir::bench::bench_main(argc, argv, app, [&] { run(options); });
}
