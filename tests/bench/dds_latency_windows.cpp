#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/bench/dds_latency.h"

namespace nadir::bench {

double quantile(std::vector<double> values, double q) {
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  const std::size_t index = rank < 1.0 ? 0 : static_cast<std::size_t>(rank) - 1;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), nth, values.end());
  return values[index];
}

std::vector<LatencyWindow> windows_of_a_second(const std::vector<Arrival>& arrivals) {
  if (arrivals.empty()) throw std::runtime_error("nothing arrived");
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::vector<LatencyWindow> windows;
  std::vector<double> latencies_us;
  std::int64_t begin_ns = arrivals.front().sent_ns;
  for (const Arrival& arrival : arrivals) {
    if (arrival.sent_ns >= begin_ns + kSecond && !latencies_us.empty()) {
      windows.push_back(
          {quantile(latencies_us, 0.5), quantile(latencies_us, 0.99), latencies_us.size()});
      latencies_us.clear();
      begin_ns += kSecond;
    }
    latencies_us.push_back(static_cast<double>(arrival.received_ns - arrival.sent_ns) * 1e-3);
  }
  if (!windows.empty()) windows.erase(windows.begin());
  return windows;
}

}  // namespace nadir::bench
