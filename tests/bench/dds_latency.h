#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nadir::bench {

// One-way latency between two processes of this machine, robots times rate samples a second, over
// DDS on the loopback interface. Measured by nadir's own writer and reader, and by ddsperf with the
// same load.

/// The load: what a tracker with one camera publishes.
struct Load {
  int robots = 12;
  double rate_hz = 100.0;
  double seconds = 5.0;
};

/// One second of one measurement.
struct LatencyWindow {
  double p50_us = 0.0;
  double p99_us = 0.0;
  std::size_t samples = 0;
};

/// One sample, on a clock that both processes share.
struct Arrival {
  std::int64_t sent_ns = 0;
  std::int64_t received_ns = 0;
};

/// Quantiles of each full second but the first. arrivals: in order of sending. Throws
/// std::runtime_error if empty.
std::vector<LatencyWindow> windows_of_a_second(const std::vector<Arrival>& arrivals);

/// Nadir: from the stamp on the finished poses, just before publish(), to the reader's callback in
/// this process; the sender is a child process (send_poses). All poses of a frame carry the same
/// stamp: the last one of a frame has waited for those before it. The first second is left out.
/// Throws std::runtime_error if nothing arrives.
std::vector<LatencyWindow> measure_nadir(const Load& load);

/// The sending side of measure_nadir; runs until it is killed or for `load.seconds` and some.
void send_poses(const Load& load, std::uint32_t domain);

/// ddsperf's publisher, seen by a reader of this process with a listener, measured as nadir is:
/// from the stamp of the burst's first sample. payload_bytes: size of a sample. Empty if ddsperf is
/// not installed.
std::vector<LatencyWindow> measure_ddsperf_one_way(const Load& load, std::size_t payload_bytes);

/// What ddsperf says itself: half of the round trip of each sample under the same load, from each
/// sample's own stamp. The first second is left out. Empty if ddsperf is not installed.
std::vector<LatencyWindow> measure_ddsperf_round_trip(const Load& load, std::size_t payload_bytes);

/// The latency lines of ddsperf's output ("... size 256 mean 73.4us ... 50% 69.8us 90% .. 99%
/// 166.8us .. cnt 1200").
std::vector<LatencyWindow> parse_ddsperf(const std::string& text);

/// Size of a pose on the wire, bytes: serialized by DDS, without its 4-byte header.
std::size_t pose_payload_bytes();

/// The value below which the share `q` (0 to 1) of the values lies, nearest rank. values: not
/// empty.
double quantile(std::vector<double> values, double q);

}  // namespace nadir::bench
