#include "vision/synthetic/scene_file_live.h"

namespace nadir::vision {

SceneDelivery read_delivery(const YamlMap& map) {
  SceneDelivery delivery;
  if (map.has("delay_ms")) {
    const std::vector<double> delays_ms = map.numbers("delay_ms", 0, {0.0, 10000.0});
    if (delays_ms.empty() || delays_ms.size() > 2 || delays_ms.front() > delays_ms.back()) {
      throw map.error("delay_ms", "the delay is no range",
                      "give one number in brackets, or the lowest and the highest: [60, 100]");
    }
    delivery.shortest_delay_s = 1e-3 * delays_ms.front();
    delivery.longest_delay_s = 1e-3 * delays_ms.back();
  }
  delivery.loss = map.number_or("loss", delivery.loss, {0.0, 0.99});
  if (map.has("blackouts")) {
    for (const YamlMap& entry : map.maps("blackouts")) {
      SceneBlackout blackout;
      blackout.start_s = entry.number("start_s", {0.0, 1e9});
      blackout.length_s = entry.number("length_s", {0.0, 1e4});
      entry.finish();
      delivery.blackouts.push_back(blackout);
    }
  }
  map.finish();
  return delivery;
}

}  // namespace nadir::vision
