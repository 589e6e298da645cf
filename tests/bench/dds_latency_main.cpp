// dds_latency: how long a pose needs from the tracker to the process of a robot, beside ddsperf
// under the same load.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "tests/bench/bench_program.h"
#include "tests/bench/dds_latency.h"

namespace {

using nadir::bench::LatencyWindow;
using nadir::bench::Load;

constexpr double kGoalRatio = 1.3;  // p50 beside ddsperf's

struct Options {
  Load load;
  int rounds = 3;
  std::string json_file;
  bool send = false;
  std::uint32_t domain = 0;
};

struct Summary {
  double p50_us = 0.0;  ///< median over the seconds
  double p99_us = 0.0;
  std::size_t seconds = 0;
};

struct Result {
  std::size_t payload_bytes = 0;
  Summary nadir;
  Summary one_way;     ///< of ddsperf's writer; no seconds if it is not installed
  Summary round_trip;  ///< half of it, as ddsperf prints it
};

Summary summarize(const std::vector<LatencyWindow>& windows) {
  std::vector<double> p50;
  std::vector<double> p99;
  for (const LatencyWindow& window : windows) {
    p50.push_back(window.p50_us);
    p99.push_back(window.p99_us);
  }
  if (windows.empty()) return {};
  return {nadir::bench::quantile(p50, 0.5), nadir::bench::quantile(p99, 0.5), windows.size()};
}

void append(const std::vector<LatencyWindow>& more, std::vector<LatencyWindow>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

std::string row(const char* name, const Summary& summary) {
  return fmt::format("{:<28} {:>8.1f} {:>8.1f} {:>8}\n", name, summary.p50_us, summary.p99_us,
                     summary.seconds);
}

std::string ratio_row(const char* name, const Summary& nadir, const Summary& other) {
  return fmt::format("{:<28} {:>8.2f} {:>8.2f}\n", name, nadir.p50_us / other.p50_us,
                     nadir.p99_us / other.p99_us);
}

std::string table(const Result& result) {
  std::string text = fmt::format("{:<28} {:>8} {:>8} {:>8}\n", "", "p50_us", "p99_us", "seconds");
  text += row("nadir, one way", result.nadir);
  if (result.one_way.seconds == 0) {
    return text + "ddsperf is not installed (package cyclonedds-tools): no comparison\n";
  }
  text += row("ddsperf's writer, one way", result.one_way);
  text += row("ddsperf, round trip / 2", result.round_trip);
  text += ratio_row("nadir / ddsperf one way", result.nadir, result.one_way);
  text += ratio_row("nadir / round trip / 2", result.nadir, result.round_trip);
  return text + fmt::format("Goal: ratio at most {}\n", kGoalRatio);
}

std::string json(const Options& options, const Result& result) {
  const auto fields = [](const Summary& s) {
    return s.seconds == 0
               ? std::string("null")
               : fmt::format("{{\"p50_us\": {:.2f}, \"p99_us\": {:.2f}, \"seconds\": {}}}",
                             s.p50_us, s.p99_us, s.seconds);
  };
  const auto ratio = [&result](const Summary& other) {
    return other.seconds == 0 ? std::string("null")
                              : fmt::format("{:.3f}", result.nadir.p50_us / other.p50_us);
  };
  return fmt::format(
      "{{\"benchmark\": \"dds_latency\", \"robots\": {}, \"rate_hz\": {}, \"payload_bytes\": {}, "
      "\"nadir_one_way\": {}, \"ddsperf_one_way\": {}, \"ddsperf_half_round_trip\": {}, "
      "\"p50_ratio_one_way\": {}, \"p50_ratio_half_round_trip\": {}, \"goal_ratio\": {}}}\n",
      options.load.robots, options.load.rate_hz, result.payload_bytes, fields(result.nadir),
      fields(result.one_way), fields(result.round_trip), ratio(result.one_way),
      ratio(result.round_trip), kGoalRatio);
}

/// The three alternate, so that what else the machine does strikes all.
Result measure(const Options& options) {
  Result result;
  result.payload_bytes = nadir::bench::pose_payload_bytes();
  std::vector<LatencyWindow> nadir_windows;
  std::vector<LatencyWindow> one_way;
  std::vector<LatencyWindow> round_trip;
  for (int round = 0; round < options.rounds; ++round) {
    append(nadir::bench::measure_nadir(options.load), &nadir_windows);
    append(nadir::bench::measure_ddsperf_one_way(options.load, result.payload_bytes), &one_way);
    append(nadir::bench::measure_ddsperf_round_trip(options.load, result.payload_bytes),
           &round_trip);
  }
  result.nadir = summarize(nadir_windows);
  result.one_way = summarize(one_way);
  result.round_trip = summarize(round_trip);
  return result;
}

void report(const Options& options, const Result& result) {
  fmt::print(
      "Latency between two processes: {} robots at {} Hz, {} bytes each, keyed, best effort\n{}",
      options.load.robots, options.load.rate_hz, result.payload_bytes, table(result));
  if (options.json_file.empty()) return;
  std::ofstream file(options.json_file);
  file << json(options, result);
  if (!file.flush()) throw std::runtime_error("cannot write " + options.json_file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("One-way latency of poses between two processes, beside ddsperf.", "dds_latency");
  app.footer("Example: dds_latency --rounds 3 --seconds 5 --json latency.json");
  app.add_option("--json", options.json_file, "write the result to this file too");
  app.add_option("--rounds", options.rounds, "rounds of nadir and ddsperf in turn")
      ->check(CLI::PositiveNumber);
  app.add_option("--seconds", options.load.seconds, "length of a measurement")
      ->check(CLI::Range(3.0, 3600.0));
  app.add_option("--robots", options.load.robots)->check(CLI::Range(1, 128));
  app.add_option("--rate", options.load.rate_hz, "frames a second")->check(CLI::Range(1.0, 1000.0));
  app.add_flag("--send", options.send, "be the sending process (started by the measurement)");
  app.add_option("--domain", options.domain, "DDS domain, with --send");
  return nadir::bench::bench_main(argc, argv, app, [&options] {
    if (options.send) {
      nadir::bench::send_poses(options.load, options.domain);
    } else {
      report(options, measure(options));
    }
  });
}
