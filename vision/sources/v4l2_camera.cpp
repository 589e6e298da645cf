#include "vision/sources/v4l2_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace nadir::vision {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds kPatience{100};  // of one wait: whoever reads wants to be able to stop
constexpr nanoseconds kFirstBackOff = milliseconds(100);
constexpr nanoseconds kLongestBackOff = std::chrono::seconds(1);
constexpr nanoseconds kSilenceBeforeReopening = std::chrono::seconds(5);
constexpr int kIntervalsBeforeComplaint = 3;

}  // namespace

V4l2Camera::V4l2Camera(std::string device, const V4l2Request& request, V4l2System& system)
    : device_(std::move(device)), request_(request), system_(system) {}

V4l2Camera::~V4l2Camera() = default;

ReadResult V4l2Camera::read(Frame& frame) {
  if (!stream_ && !open_when_due()) return unavailable(problem_);
  return wait_for_picture(frame);
}

ReadResult V4l2Camera::unavailable(const std::string& problem) const {
  return {ReadStatus::kUnavailable, "v4l2:" + device_ + ": " + problem};
}

bool V4l2Camera::open_when_due() {
  if (const nanoseconds early = next_try_ - system_.monotonic_now(); early.count() > 0) {
    system_.sleep(std::min<nanoseconds>(early, kPatience));
    if (early > kPatience) return false;
  }
  try {
    stream_ = std::make_unique<V4l2Stream>(system_, device_, request_);
  } catch (const std::runtime_error& error) {
    lose(error.what());
    return false;
  }
  has_sequence_ = false;
  last_sign_of_life_ = system_.monotonic_now();
  return true;
}

ReadResult V4l2Camera::wait_for_picture(Frame& frame) {
  while (true) {
    V4l2Picture picture;
    switch (stream_->take_newest(kPatience, picture)) {
      case V4l2Stream::Wait::kPicture: {
        back_off_ = nanoseconds(0);
        last_sign_of_life_ = system_.monotonic_now();
        ReadResult result = convert(picture, frame);
        // A device that is lost just now says so at the next call; this picture is good.
        stream_->give_back(picture);
        return result;
      }
      case V4l2Stream::Wait::kLost:
        lose("the camera went away");
        return unavailable(problem_);
      case V4l2Stream::Wait::kNothing:
        break;
    }
    const nanoseconds silence = system_.monotonic_now() - last_sign_of_life_;
    const nanoseconds interval = stream_->frame_interval();
    const std::string problem =
        fmt::format("no picture for {:.1f} s", std::chrono::duration<double>(silence).count());
    if (silence > std::max(kSilenceBeforeReopening, 2 * kIntervalsBeforeComplaint * interval)) {
      lose(problem);
      return unavailable(problem_);
    }
    if (silence > kIntervalsBeforeComplaint * interval) return unavailable(problem);
  }
}

ReadResult V4l2Camera::convert(const V4l2Picture& picture, Frame& frame) {
  const std::uint64_t number = number_of(picture.sequence);
  const DecodeStatus status = picture.is_damaged
                                  ? DecodeStatus::kIncomplete
                                  : convert_picture(picture.bytes, stream_->layout(), frame.image);
  if (status != DecodeStatus::kDecoded) {
    return {ReadStatus::kSkipped, fmt::format("v4l2:{}: picture {} {}; the frame is skipped",
                                              device_, number, decode_status_text(status))};
  }
  frame.number = number;
  frame.capture_time = picture.capture_time;
  return {ReadStatus::kFrame, {}};
}

void V4l2Camera::lose(const std::string& problem) {
  stream_.reset();
  problem_ = problem + "; nadir keeps trying";
  back_off_ = std::clamp(2 * back_off_, kFirstBackOff, kLongestBackOff);
  next_try_ = system_.monotonic_now() + back_off_;
}

std::uint64_t V4l2Camera::number_of(std::uint32_t sequence) {
  // The driver's count wraps at 32 bits. A driver that does not count, or counts backwards, adds
  // one a picture.
  const std::uint32_t step = sequence - last_sequence_;
  constexpr std::uint32_t kBackwards = 1U << 31U;
  const bool counts = has_sequence_ && step != 0 && step < kBackwards;
  next_number_ += counts ? step - 1 : 0;
  last_sequence_ = sequence;
  has_sequence_ = true;
  return next_number_++;
}

}  // namespace nadir::vision
