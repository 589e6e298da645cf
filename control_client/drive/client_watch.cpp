#include "control_client/drive/client_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "fusion/timestamp.h"
#include "tracker/wire/clock_exchange.h"

namespace nadir::control_client {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The truth at a time near one of the samples, with its velocity.
std::optional<fusion::PlanarPose> truth_at(const std::deque<tracker::WireSimulatedTruth>& samples,
                                           std::int64_t time_ns) {
  constexpr std::int64_t kNear_ns = 20'000'000;
  const auto nearest = std::ranges::min_element(
      samples, {}, [&](const auto& sample) { return std::abs(sample.time_ns - time_ns); });
  if (nearest == samples.end() || std::abs(nearest->time_ns - time_ns) > kNear_ns) {
    return std::nullopt;
  }
  const double dt_s = 1e-9 * static_cast<double>(time_ns - nearest->time_ns);
  const fusion::PlanarPose& pose = nearest->pose_world_robot;
  return fusion::PlanarPose{
      pose.x_m + dt_s * nearest->velocity_x_mps, pose.y_m + dt_s * nearest->velocity_y_mps,
      fusion::wrap_angle(pose.heading_rad + dt_s * nearest->heading_rate_radps)};
}

}  // namespace

void ClientWatch::add(const tracker::WireClientState& state) {
  Client& client = clients_[{state.team, state.robot}];
  client.state = state;
  client.heard_ns = tracker::system_clock_ns();
}

void ClientWatch::add(const tracker::WireSimulatedTruth& truth) {
  constexpr std::int64_t kKept_ns = 500'000'000;
  const auto client = clients_.find({truth.team, truth.robot});
  if (client == clients_.end()) return;
  auto& samples = client->second.truth;
  samples.push_back(truth);
  while (samples.front().time_ns < truth.time_ns - kKept_ns) samples.pop_front();
}

std::string ClientWatch::line(std::int64_t now_ns) const {
  constexpr std::int64_t kSilent_ns = 2'000'000'000;
  std::string line;
  for (const auto& [key, client] : clients_) {
    if (now_ns - client.heard_ns > kSilent_ns) continue;
    const tracker::WireClientState& state = client.state;
    line += fmt::format("{}{} {} {}", line.empty() ? "" : " | ", key.first, key.second,
                        tracker::name_of(state.mode));
    if (state.reason != tracker::ClientReason::kNone) {
      line += fmt::format(" ({})", tracker::name_of(state.reason));
    }
    line += errors(client);
  }
  return line;
}

std::string ClientWatch::errors(const Client& client) {
  const tracker::WireClientState& state = client.state;
  if (state.clock_sigma_ns < 0 || state.pose_age_ns < 0) return "";
  if (const auto truth = truth_at(client.truth, state.stamp_ns + state.clock_offset_ns)) {
    const Eigen::Vector3d error = fusion::pose_difference(state.estimate_world_robot, *truth);
    return fmt::format(" {:4.1f} mm {:4.2f} deg", 1e3 * error.head<2>().norm(),
                       kDegrees * std::abs(error.z()));
  }
  return fmt::format(" {:4.1f} mm off its path",
                     1e3 * std::hypot(state.error_ahead_m, state.error_left_m));
}

}  // namespace nadir::control_client
