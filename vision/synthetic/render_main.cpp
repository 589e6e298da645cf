#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "vision/input/input_error.h"
#include "vision/input/usage_line.h"
#include "vision/synthetic/recording.h"
#include "vision/synthetic/renderer.h"

namespace {

using nadir::vision::PictureFormat;

struct Options {
  std::string scene;
  std::string output;
  std::uint64_t frames = 0;
  std::uint64_t seed = 1;
  bool jpeg = false;
};

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

void run(const Options& options) {
  nadir::vision::Scene scene = nadir::vision::load_scene(options.scene);
  nadir::vision::Renderer renderer(std::move(scene), options.seed);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  nadir::vision::write_recording(
      renderer, options.seed, options.frames, options.output,
      [&](std::uint64_t done) {
        if (!terminal) return;
        fmt::print(stderr, "\r{} of {} frames", done, options.frames);
        if (done == options.frames) fmt::print(stderr, "\n");
      },
      options.jpeg ? PictureFormat::kJpeg : PictureFormat::kPng);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Synthetic camera: renders a scene to pictures, capture times, exact truth and "
      "calibration points.",
      "nadir-render");
  app.footer(
      "Example: nadir-render data/scenes/league_even.yaml -o recording --frames 20 --seed 1");
  app.failure_message(nadir::vision::usage_line);
  app.set_version_flag("--version", "nadir-render " NADIR_VERSION);
  app.add_option("scene", options.scene, "scene file (YAML)")->required()->type_name("SCENE.yaml");
  app.add_option("-o,--output", options.output, "folder to write; made if absent")
      ->required()
      ->type_name("DIR");
  app.add_option("--frames", options.frames, "number of frames")
      ->required()
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}));
  app.add_option("--seed", options.seed, "seed of everything random")->capture_default_str();
  app.add_flag("--jpeg", options.jpeg, "pictures as JPEG, quality 95, instead of exact PNG");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongInput;
  }
  try {
    run(options);
  } catch (const nadir::vision::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kWrongInput;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "{}: {}\n", options.scene, error.what());
    return kWrongInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kFailed;
  }
  return kDone;
}
