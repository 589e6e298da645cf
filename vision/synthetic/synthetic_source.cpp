#include "vision/synthetic/synthetic_source.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "vision/input/input_error.h"

namespace nadir::vision {

using std::chrono::duration;
using std::chrono::duration_cast;

namespace {

constexpr std::chrono::milliseconds kLongestSilence{100};  // of a camera that is away
constexpr double kBuffers = 3.0;  // frames that a camera keeps for a reader that is late

Renderer renderer_of(Scene scene, std::uint64_t seed) {
  try {
    return Renderer(std::move(scene), seed);
  } catch (const std::invalid_argument& error) {
    throw InputError({}, std::string("the scene cannot be shown: ") + error.what(),
                     "change the scene");
  }
}

/// Which layout and team a live robot has; nothing if the scene does not know it.
std::optional<RobotPlacement> placement_of(const Scene& scene, const LiveRobot& robot) {
  if (!scene.live_robots) return std::nullopt;
  for (const std::size_t index : scene.live_robots->layouts) {
    const MarkerLayout& layout = scene.layouts[index];
    const auto team = std::ranges::find(layout.teams, robot.team, &Team::name);
    if (team == layout.teams.end() || !layout.has_robot(robot.id)) continue;
    return RobotPlacement{index, static_cast<std::size_t>(team - layout.teams.begin()), robot.id,
                          robot.motion};
  }
  return std::nullopt;
}

}  // namespace

SyntheticSource::SyntheticSource(Scene scene, std::uint64_t seed, SyntheticPace pace)
    : renderer_(renderer_of(std::move(scene), seed)),
      pace_(pace),
      delivery_(renderer_.scene().delivery, renderer_.scene().rate_hz, seed) {}

SyntheticSource::SyntheticSource(Scene scene, std::uint64_t seed,
                                 std::shared_ptr<LiveRobots> robots)
    : SyntheticSource(std::move(scene), seed, SyntheticPace::kRealTime) {
  live_ = std::move(robots);
}

void SyntheticSource::seek(std::uint64_t frame_number) {
  next_ = frame_number;
  started_ = false;
}

void SyntheticSource::start() {
  started_ = true;
  first_ = next_;
  start_ = Clock::now();
  start_wall_ =
      std::chrono::time_point_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now());
  arrival_ = start_;
}

SyntheticSource::Clock::time_point SyntheticSource::exposure_time(
    std::uint64_t frame_number) const {
  return start_ + duration_cast<Clock::duration>(renderer_.capture_time(frame_number) -
                                                 renderer_.capture_time(first_));
}

void SyntheticSource::keep_pace() {
  if (!started_) start();
  std::this_thread::sleep_until(exposure_time(next_));
}

bool SyntheticSource::wait_for_delivery() {
  if (!started_) start();
  const auto patience =
      duration_cast<Clock::duration>(duration<double>(kBuffers / renderer_.scene().rate_hz));
  while (true) {
    const Clock::time_point exposed = exposure_time(next_);
    const Clock::time_point now = Clock::now();
    const std::optional<double> delay_s = delivery_.delay_s(next_);
    if (!delay_s) {
      // In a long time without frames the reader hears of it now and then.
      if (exposed > now + kLongestSilence) {
        std::this_thread::sleep_for(kLongestSilence);
        return false;
      }
      ++next_;
      continue;
    }
    const auto delay = duration_cast<Clock::duration>(duration<double>(*delay_s));
    arrival_ = std::max(arrival_, exposed + delay);
    if (now >= arrival_ + patience) {  // nobody fetched it in time
      ++next_;
      continue;
    }
    std::this_thread::sleep_until(std::max(exposed, arrival_ - rendering_time_));
    return true;
  }
}

void SyntheticSource::add_live_robots(CaptureTime time) {
  live_->at(time, live_robots_);
  for (const LiveRobot& robot : live_robots_) {
    if (const auto placement = placement_of(renderer_.scene(), robot)) {
      placements_.push_back(*placement);
    } else {
      live_->cannot_show(robot);
    }
  }
}

void SyntheticSource::render(const Frame& frame, cv::Mat& image) {
  placements_ = renderer_.placements(frame.number);
  if (live_) add_live_robots(frame.capture_time);
  const Clock::time_point begin = Clock::now();
  renderer_.render_robots(frame.number, placements_, image);
  rendering_time_ = Clock::now() - begin;
}

ReadResult SyntheticSource::read(Frame& frame) {
  const auto ended = [this] {
    const std::uint64_t frames = renderer_.scene().frames;
    return frames > 0 && next_ >= frames;
  };
  if (ended()) return {ReadStatus::kEnd, ""};
  const bool real_time = pace_ == SyntheticPace::kRealTime;
  if (pace_ == SyntheticPace::kRecorded) keep_pace();
  if (real_time && !wait_for_delivery()) {
    return {ReadStatus::kUnavailable, "the scene's delivery is interrupted"};
  }
  if (ended()) return {ReadStatus::kEnd, ""};
  frame.number = next_++;
  frame.capture_time = renderer_.capture_time(frame.number);
  if (real_time) {
    frame.capture_time = start_wall_ + (frame.capture_time - renderer_.capture_time(first_));
  }
  try {
    render(frame, frame.image);
  } catch (const std::exception& error) {  // a frame whose random robots find no room
    return {ReadStatus::kSkipped, "frame " + std::to_string(frame.number) + ": " + error.what()};
  }
  if (real_time) std::this_thread::sleep_until(arrival_);
  return {ReadStatus::kFrame, ""};
}

}  // namespace nadir::vision
