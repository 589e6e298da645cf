// nadir-listen: prints what trackers and clients publish.

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tracker/listen/listen_silence.h"
#include "tracker/listen/listen_text.h"
#include "tracker/wire/pose_reader.h"
#include "tracker/wire/value_streams.h"
#include "vision/input/usage_line.h"

namespace {

using nadir::tracker::ClientStateReader;
using nadir::tracker::FrameReader;
using nadir::tracker::Participant;
using nadir::tracker::PoseReader;
using nadir::tracker::ReaderOptions;
using nadir::tracker::Speaker;
using nadir::tracker::WireClientState;
using nadir::tracker::WireFrame;
using nadir::tracker::WirePose;
using SteadyClock = std::chrono::steady_clock;

volatile std::sig_atomic_t stop_requested = 0;

struct Options {
  ReaderOptions reader;
  bool json = false;
  bool frames = false;
  bool clients = false;
  std::uint64_t count = 0;  ///< 0: without end
};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string line(const WirePose& pose, bool json) {
  return json ? nadir::tracker::pose_json(pose, now_ns())
              : nadir::tracker::pose_columns(pose, now_ns());
}
std::string line(const WireFrame& frame, bool json) {
  return json ? nadir::tracker::frame_json(frame, now_ns())
              : nadir::tracker::frame_columns(frame, now_ns());
}
std::string line(const WireClientState& state, bool json) {
  return json ? nadir::tracker::client_json(state, now_ns())
              : nadir::tracker::client_columns(state, now_ns());
}

/// Says why nothing is printed: first after 3 s of silence, then at a slow rate.
class SilenceWatch {
 public:
  explicit SilenceWatch(const Options& options)
      : options_(options.reader),
        speaker_(options.clients ? Speaker::kClient : Speaker::kTracker) {}

  void printed() {
    last_print_ = SteadyClock::now();
    next_words_ = last_print_ + std::chrono::seconds(3);
  }

  template <typename Reader>
  void look(const Reader& reader) {
    const auto now = SteadyClock::now();
    if (now < next_words_) return;
    next_words_ = now + std::chrono::seconds(15);
    const double silent_s = std::chrono::duration<double>(now - last_print_).count();
    const std::string words = nadir::tracker::explain_silence(
        options_, speaker_, reader.status(), silent_s, nadir::tracker::network_interfaces(),
        std::getenv("CYCLONEDDS_URI"));
    std::fprintf(stderr, "nadir-listen: %s\n", words.c_str());
  }

 private:
  const ReaderOptions& options_;
  Speaker speaker_;
  SteadyClock::time_point last_print_ = SteadyClock::now();
  SteadyClock::time_point next_words_ = last_print_ + std::chrono::seconds(3);
};

/// Prints until interrupted, until `count` lines are out, or until nobody reads them (false).
template <typename Value, typename Reader>
bool listen(const Options& options, Reader reader) {
  SilenceWatch silence(options);
  Value value;
  std::uint64_t lines = 0;
  while (stop_requested == 0 && (options.count == 0 || lines < options.count)) {
    if (!reader.poll(&value, std::chrono::milliseconds(100))) {
      silence.look(reader);
      continue;
    }
    if (std::puts(line(value, options.json).c_str()) < 0 || std::fflush(stdout) != 0) return false;
    silence.printed();
    ++lines;
  }
  const std::uint64_t dropped = reader.status().dropped;
  if (dropped > 0) {
    std::fprintf(stderr, "nadir-listen: %llu dropped, the output was too slow\n",
                 static_cast<unsigned long long>(dropped));
  }
  return true;
}

bool listen(const Options& options) {
  const Participant participant(options.reader.wire);
  if (options.frames) return listen<WireFrame>(options, FrameReader(participant, options.reader));
  if (options.clients) {
    const nadir::tracker::PoseFilter& wanted = options.reader.filter;
    return listen<WireClientState>(
        options,
        ClientStateReader(participant, {wanted.robot, wanted.team}, options.reader.queue_capacity));
  }
  return listen<WirePose>(options, PoseReader(participant, options.reader));
}

std::string header(const Options& options) {
  if (options.frames) return nadir::tracker::frame_columns_header();
  if (options.clients) return nadir::tracker::client_columns_header();
  return nadir::tracker::pose_columns_header();
}

void describe_options(CLI::App* app, Options* options) {
  ReaderOptions& reader = options->reader;
  app->failure_message(nadir::vision::usage_line);
  app->set_version_flag("--version", "nadir-listen " NADIR_VERSION);
  app->footer("Example: nadir-listen --domain 0 --robot 3 --json --count 100");
  app->add_option("--domain", reader.wire.domain, "DDS domain")
      ->check(CLI::Range(0U, nadir::tracker::kMaxDomain))
      ->capture_default_str();
  app->add_option("--partition", reader.wire.partition, "DDS partition");
  auto* robot = app->add_option("--robot", reader.filter.robot, "only the robot with this id");
  auto* team = app->add_option("--team", reader.filter.team, "only robots of this team");
  app->add_option("--camera", reader.filter.camera, "only what this camera sees");
  app->add_flag("--json", options->json, "JSON lines instead of columns");
  app->add_flag("--frames", options->frames, "whole frames, also empty ones, instead of poses")
      ->excludes(robot)
      ->excludes(team);
  app->add_flag("--clients", options->clients,
                "what the robots' clients say of themselves, instead of poses")
      ->excludes("--frames")
      ->excludes("--camera");
  app->add_option("--count", options->count, "end after this many lines")
      ->check(CLI::PositiveNumber);
}

void stop_on_interrupt() {
  const auto stop = [](int) { stop_requested = 1; };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Prints poses as they are published (pose, 1-sigma, covariance and age), or frames, or "
      "the states of clients.",
      "nadir-listen");
  describe_options(&app, &options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  stop_on_interrupt();
  try {
    if (!options.json) {
      std::fprintf(stderr, "%s\n", header(options).c_str());
    }
    return listen(options) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nadir-listen: %s\n", error.what());
    return 1;
  }
}
