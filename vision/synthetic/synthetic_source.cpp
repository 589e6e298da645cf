#include "vision/synthetic/synthetic_source.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "vision/input/input_error.h"

namespace nadir::vision {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::steady_clock;

namespace {

Renderer renderer_of(Scene scene, std::uint64_t seed) {
  try {
    return Renderer(std::move(scene), seed);
  } catch (const std::invalid_argument& error) {
    throw InputError({}, std::string("the scene cannot be shown: ") + error.what(),
                     "change the scene");
  }
}

}  // namespace

SyntheticSource::SyntheticSource(Scene scene, std::uint64_t seed, SyntheticPace pace)
    : renderer_(renderer_of(std::move(scene), seed)), pace_(pace) {}

void SyntheticSource::seek(std::uint64_t frame_number) {
  next_ = frame_number;
  started_ = false;
}

void SyntheticSource::keep_pace() {
  if (!started_) {
    started_ = true;
    first_ = next_;
    start_ = steady_clock::now();
    start_wall_ =
        std::chrono::time_point_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now());
    return;
  }
  const double period_s = 1.0 / renderer_.scene().rate_hz;
  if (pace_ == SyntheticPace::kRealTime) {
    const double passed_s = duration<double>(steady_clock::now() - start_).count();
    const auto newest = first_ + static_cast<std::uint64_t>(passed_s / period_s);
    next_ = std::max(next_, newest);
  }
  const duration<double> due(static_cast<double>(next_ - first_) * period_s);
  std::this_thread::sleep_until(start_ + duration_cast<steady_clock::duration>(due));
}

ReadResult SyntheticSource::read(Frame& frame) {
  const auto ended = [this] {
    const std::uint64_t frames = renderer_.scene().frames;
    return frames > 0 && next_ >= frames;
  };
  if (ended()) return {ReadStatus::kEnd, ""};
  if (pace_ != SyntheticPace::kFastest) keep_pace();
  if (ended()) return {ReadStatus::kEnd, ""};
  frame.number = next_;
  frame.capture_time = renderer_.capture_time(next_);
  if (pace_ == SyntheticPace::kRealTime) {
    frame.capture_time =
        start_wall_ + (renderer_.capture_time(next_) - renderer_.capture_time(first_));
  }
  try {
    renderer_.render(next_++, frame.image);
  } catch (const std::exception& error) {  // a frame whose random robots find no room
    return {ReadStatus::kSkipped, "frame " + std::to_string(frame.number) + ": " + error.what()};
  }
  return {ReadStatus::kFrame, ""};
}

}  // namespace nadir::vision
