#include <chrono>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/bench/dds_latency.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tests/support/test_poses.h"
#include "tracker/wire/pose_reader.h"
#include "tracker/wire/pose_writer.h"

namespace nadir::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWorkOnFrame{1};

/// One clock for all processes of the machine.
std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(SteadyClock::now().time_since_epoch())
      .count();
}

}  // namespace

std::vector<LatencyWindow> measure_nadir(const Load& load) {
  const test::LoopbackDds dds;
  std::mutex mutex;
  std::vector<Arrival> arrivals;
  arrivals.reserve(static_cast<std::size_t>(1.5 * (load.seconds + 2.0) * load.rate_hz *
                                            static_cast<double>(load.robots)));
  tracker::ReaderOptions options;
  options.wire.domain = dds.domain();
  tracker::PoseReader reader(options, [&](const tracker::WirePose& pose) {
    const std::int64_t received_ns = steady_ns();
    const std::lock_guard lock(mutex);
    arrivals.push_back({pose.capture_ns, received_ns});
  });
  test::ChildProcess sender(
      std::filesystem::read_symlink("/proc/self/exe"),
      {"--send", "--domain", std::to_string(dds.domain()), "--robots", std::to_string(load.robots),
       "--rate", std::to_string(load.rate_hz), "--seconds", std::to_string(load.seconds)},
      dds.environment());
  const auto patience =
      std::chrono::milliseconds(20000 + static_cast<std::int64_t>(1000.0 * load.seconds));
  if (sender.wait(patience) != 0) throw std::runtime_error("the sender failed: " + sender.err());
  const std::lock_guard lock(mutex);
  return windows_of_a_second(arrivals);
}

void send_poses(const Load& load, std::uint32_t domain) {
  tracker::PoseWriter writer({.domain = domain, .partition = ""});
  while (writer.status().matched_pose_readers == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::vector<tracker::WirePose> poses(static_cast<std::size_t>(load.robots));
  const auto period = std::chrono::duration_cast<SteadyClock::duration>(
      std::chrono::duration<double>(1.0 / load.rate_hz));
  const auto frames = static_cast<std::uint64_t>((load.seconds + 0.5) * load.rate_hz);
  auto next = SteadyClock::now();
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    // A tracker works on its frame until the poses are finished: this process is awake when it
    // publishes.
    std::this_thread::sleep_until(next - kWorkOnFrame);
    do {
      for (int robot = 0; robot < load.robots; ++robot) {
        poses[static_cast<std::size_t>(robot)] = test::test_pose(1, frame, robot);
      }
    } while (SteadyClock::now() < next);
    const std::int64_t finished_ns = steady_ns();
    for (tracker::WirePose& pose : poses) pose.capture_ns = finished_ns;
    writer.publish(poses);
    next += period;
  }
}

}  // namespace nadir::bench
