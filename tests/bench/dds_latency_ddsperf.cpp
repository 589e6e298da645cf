#include <fmt/format.h>

#include <chrono>
#include <sstream>
#include <stdexcept>

#include "ddsperf_sample.h"  // written by idlc
#include "tests/bench/dds_latency.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tracker/wire/dds_entities.h"

namespace nadir::bench {
namespace {

bool is_installed() {
  try {
    test::ChildProcess help("ddsperf", {"help"});
    return help.wait(std::chrono::seconds(10)).value_or(127) != 127;
  } catch (const std::runtime_error&) {
    return false;
  }
}

std::vector<std::string> common_arguments(const Load& load, std::uint32_t domain) {
  return {"-u", "-T", "KS", "-n", std::to_string(load.robots), "-i", std::to_string(domain)};
}

std::vector<std::string> publish_arguments(const Load& load, std::uint32_t domain,
                                           std::size_t payload_bytes) {
  std::vector<std::string> arguments = common_arguments(load, domain);
  arguments.insert(
      arguments.end(),
      {"-D", fmt::format("{}", load.seconds + 1.5), "pub", fmt::format("{}Hz", load.rate_hz),
       "burst", std::to_string(load.robots), "size", std::to_string(payload_bytes)});
  return arguments;
}

std::chrono::milliseconds patience(const Load& load) {
  return std::chrono::milliseconds(20000 + static_cast<std::int64_t>(1000.0 * load.seconds));
}

/// Notes when the samples of ddsperf's publisher arrive. Robot 0 opens each burst.
struct BurstListener {
  std::vector<Arrival> arrivals;
  std::int64_t burst_sent_ns = 0;

  static void on_data(dds_entity_t reader, void* self) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) == 1) {
      const std::int64_t received_ns = dds_time();
      auto* listener = static_cast<BurstListener*>(self);
      if (info.valid_data) {
        if (static_cast<const KeyedSeq*>(sample)->robot == 0) {
          listener->burst_sent_ns = info.source_timestamp;
        }
        if (listener->burst_sent_ns != 0) {
          listener->arrivals.push_back({listener->burst_sent_ns, received_ns});
        }
      }
      dds_return_loan(reader, &sample, 1);
      sample = nullptr;
    }
  }
};

}  // namespace

std::vector<LatencyWindow> parse_ddsperf(const std::string& text) {
  std::vector<LatencyWindow> windows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    LatencyWindow window;
    bool complete = false;
    std::istringstream words(line);
    for (std::string name; words >> name;) {
      std::string unit;
      if (name == "50%") words >> window.p50_us >> unit;
      if (name == "99%") words >> window.p99_us >> unit;
      if (name == "cnt") complete = static_cast<bool>(words >> window.samples);
    }
    if (complete && window.p50_us > 0.0 && window.p99_us > 0.0) windows.push_back(window);
  }
  return windows;
}

std::vector<LatencyWindow> measure_ddsperf_round_trip(const Load& load, std::size_t payload_bytes) {
  if (!is_installed()) return {};
  const test::LoopbackDds dds;
  std::vector<std::string> receive = common_arguments(load, dds.domain());
  receive.insert(receive.end(), {"-D", fmt::format("{}", load.seconds + 10.0), "sub"});
  test::ChildProcess receiver("ddsperf", receive, dds.environment());
  std::vector<std::string> send = publish_arguments(load, dds.domain(), payload_bytes);
  send.emplace_back("100%");  // each sample is answered
  test::ChildProcess sender("ddsperf", send, dds.environment());
  sender.wait(patience(load));
  std::vector<LatencyWindow> windows = parse_ddsperf(sender.out());
  if (windows.empty()) throw std::runtime_error("ddsperf gave no latency:\n" + sender.out());
  windows.erase(windows.begin());
  return windows;
}

std::vector<LatencyWindow> measure_ddsperf_one_way(const Load& load, std::size_t payload_bytes) {
  if (!is_installed()) return {};
  const test::LoopbackDds dds;
  BurstListener listener;
  const tracker::DdsEntity participant =
      tracker::make_participant({.domain = dds.domain(), .partition = ""});
  const tracker::DdsEntity topic =
      tracker::make_topic(participant, KeyedSeq_desc, "DDSPerfUDataKS");
  const tracker::DdsQos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  const tracker::DdsListener callbacks(dds_create_listener(&listener));
  dds_lset_data_available(callbacks.get(), &BurstListener::on_data);
  tracker::DdsEntity reader(
      dds_create_reader(participant.handle(), topic.handle(), qos.get(), callbacks.get()),
      "reader of ddsperf's samples");
  test::ChildProcess sender("ddsperf", publish_arguments(load, dds.domain(), payload_bytes),
                            dds.environment());
  sender.wait(patience(load));
  reader = tracker::DdsEntity();  // from here on nobody else touches the arrivals
  return windows_of_a_second(listener.arrivals);
}

}  // namespace nadir::bench
