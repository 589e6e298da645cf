// nadir-test-publisher: publishes test poses (test_poses.h), as the second process of tests.

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/test_poses.h"
#include "tracker/wire/pose_writer.h"

namespace {

using nadir::tracker::PoseWriter;
using nadir::tracker::WirePose;
using SteadyClock = std::chrono::steady_clock;

volatile std::sig_atomic_t stop_requested = 0;

struct Options {
  nadir::tracker::WireOptions wire;
  std::string camera = "cam0";
  std::uint64_t epoch = 1;
  std::int32_t robots = 12;
  std::uint64_t frames = 0;        // 0: without end
  std::int32_t robots_later = -1;  // from frame robots_until on this many robots
  std::uint64_t robots_until = 0;
  double rate_hz = 100.0;
  int wait_for_readers = 0;
  double linger_s = 0.0;  // stays in the domain, silently, after the last frame
};

void describe_options(CLI::App* app, Options* options) {
  app->add_option("--domain", options->wire.domain);
  app->add_option("--partition", options->wire.partition);
  app->add_option("--camera", options->camera);
  app->add_option("--epoch", options->epoch);
  app->add_option("--robots", options->robots);
  app->add_option("--robots-later", options->robots_later);
  app->add_option("--robots-until", options->robots_until);
  app->add_option("--frames", options->frames);
  app->add_option("--rate", options->rate_hz);
  app->add_option("--wait-for-readers", options->wait_for_readers);
  app->add_option("--linger", options->linger_s);
}

void publish_all(const Options& options, PoseWriter* writer) {
  const auto period = std::chrono::duration_cast<SteadyClock::duration>(
      std::chrono::duration<double>(1.0 / options.rate_hz));
  auto next = SteadyClock::now();
  std::vector<WirePose> poses;
  for (std::uint64_t frame = 0; stop_requested == 0; ++frame) {
    if (options.frames != 0 && frame >= options.frames) break;
    const bool later = options.robots_later >= 0 && frame >= options.robots_until;
    const std::int32_t robots = later ? options.robots_later : options.robots;
    poses.clear();
    for (std::int32_t robot = 0; robot < robots; ++robot) {
      poses.push_back(nadir::test::test_pose(options.epoch, frame, robot, options.camera));
    }
    writer->publish(poses);
    writer->publish(nadir::test::test_frame(options.epoch, frame, robots, options.camera));
    next += period;
    std::this_thread::sleep_until(next);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Publishes test poses.");
  describe_options(&app, &options);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGTERM, [](int) { stop_requested = 1; });
  try {
    PoseWriter writer(options.wire);
    const auto matched = [&writer, &options] {
      const PoseWriter::Status status = writer.status();
      return status.matched_pose_readers + status.matched_frame_readers >= options.wait_for_readers;
    };
    while (stop_requested == 0 && !matched()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::printf("publishing\n");
    std::fflush(stdout);
    publish_all(options, &writer);
    const PoseWriter::Status status = writer.status();
    std::printf("published %llu poses, %llu frames, refused %llu, failed %llu\n",
                static_cast<unsigned long long>(status.published_poses),
                static_cast<unsigned long long>(status.published_frames),
                static_cast<unsigned long long>(status.refused),
                static_cast<unsigned long long>(status.failed));
    std::fflush(stdout);
    const auto end = SteadyClock::now() + std::chrono::duration<double>(options.linger_s);
    while (stop_requested == 0 && SteadyClock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nadir-test-publisher: %s\n", error.what());
    return 1;
  }
}
