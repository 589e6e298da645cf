#include "tracker/simulated_robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace nadir::tracker {
namespace {

/// More than any field holds: who publishes more names is broken.
constexpr std::size_t kMostRobots = 256;
constexpr std::chrono::milliseconds kLongestWait{50};

}  // namespace

SimulatedRobots::SimulatedRobots(const Participant& participant, std::chrono::nanoseconds hold,
                                 Console& console)
    : hold_(hold),
      console_(console),
      reader_(participant, {}, [this](const WireSimulatedTruth& truth) { take(truth); }) {}

void SimulatedRobots::take(const WireSimulatedTruth& truth) {
  const std::lock_guard lock(mutex_);
  auto known = std::ranges::find_if(known_, [&truth](const Known& each) {
    return each.robot == truth.robot && each.team == truth.team;
  });
  if (known == known_.end()) {
    if (known_.size() == kMostRobots) return;
    known = known_.insert(known_.end(), {truth.team, truth.robot, {}});
  }
  known->history.add(truth);
  known->is_silent = false;
  news_.notify_one();
}

bool SimulatedRobots::all_known_at(std::int64_t time_ns) const {
  return std::ranges::all_of(known_, [time_ns](const Known& each) {
    return each.is_silent || each.history.newest_ns().value_or(time_ns) >= time_ns;
  });
}

void SimulatedRobots::at(vision::CaptureTime time, std::vector<vision::LiveRobot>& robots) {
  robots.clear();
  const std::int64_t time_ns = time.time_since_epoch().count();
  std::unique_lock lock(mutex_);
  const bool known = news_.wait_for(lock, kLongestWait, [&] { return all_known_at(time_ns); });
  if (!known) {
    for (Known& each : known_) {
      each.is_silent = each.history.newest_ns().value_or(time_ns) < time_ns;
    }
  }
  std::erase_if(known_, [&](const Known& each) {
    return time_ns - each.history.newest_ns().value_or(time_ns) > hold_.count();
  });
  for (const Known& each : known_) {
    if (const auto motion = each.history.at(time_ns, hold_)) {
      robots.push_back({each.team, each.robot, *motion});
    }
  }
  // The order of arrival would be another in each run.
  std::ranges::sort(robots, {}, [](const vision::LiveRobot& robot) {
    return std::pair<std::string_view, int>(robot.team, robot.id);
  });
}

void SimulatedRobots::cannot_show(const vision::LiveRobot& robot) {
  std::uint64_t held_back = 0;
  if (!messages_.admit(std::chrono::steady_clock::now(), held_back)) return;
  console_.line(fmt::format(
      "simulated robot '{}' {} is in none of the layouts of the scene's live_robots: not shown",
      robot.team, robot.id));
}

}  // namespace nadir::tracker
