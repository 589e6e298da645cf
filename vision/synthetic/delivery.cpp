#include "vision/synthetic/delivery.h"

#include <algorithm>
#include <utility>

#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr std::uint64_t kDeliveryPurpose = 6;

}  // namespace

Delivery::Delivery(SceneDelivery delivery, double rate_hz, std::uint64_t seed)
    : delivery_(std::move(delivery)), rate_hz_(rate_hz), seed_(seed) {}

bool Delivery::is_blacked_out(std::uint64_t frame_number) const {
  const double time_s = static_cast<double>(frame_number) / rate_hz_;
  return std::ranges::any_of(delivery_.blackouts, [time_s](const SceneBlackout& blackout) {
    return time_s >= blackout.start_s && time_s < blackout.start_s + blackout.length_s;
  });
}

std::optional<double> Delivery::delay_s(std::uint64_t frame_number) const {
  if (is_blacked_out(frame_number)) return std::nullopt;
  RandomStream random(seed_, frame_number, kDeliveryPurpose);
  if (random.uniform(0.0, 1.0) < delivery_.loss) return std::nullopt;
  return random.uniform(delivery_.shortest_delay_s, delivery_.longest_delay_s);
}

}  // namespace nadir::vision
