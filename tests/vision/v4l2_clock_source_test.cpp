#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include "tests/vision/fake_v4l2.h"
#include "vision/sources/v4l2_clock.h"

namespace nadir::vision {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

v4l2_buffer picture_at(seconds second, std::chrono::microseconds fraction, std::uint32_t flags) {
  v4l2_buffer buffer{};
  buffer.timestamp.tv_sec = second.count();
  buffer.timestamp.tv_usec = fraction.count();
  buffer.flags = flags;
  return buffer;
}

TEST(V4l2Clock, ConvertsTheMonotonicClockToUnixTime) {
  FakeV4l2 system;
  const CaptureTime time = unix_time_from_monotonic(system, seconds(99) + nanoseconds(5));
  EXPECT_EQ(time.time_since_epoch(), seconds(1'700'000'099) + nanoseconds(5));
}

TEST(V4l2Clock, TakesTheMiddleOfTheExposure) {
  FakeV4l2 system;
  const milliseconds exposure(10);
  const nanoseconds stamp = seconds(1'700'000'099) + milliseconds(500);
  const v4l2_buffer at_start =
      picture_at(seconds(99), milliseconds(500),
                 V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE);
  EXPECT_EQ(capture_time_of(system, at_start, exposure).time_since_epoch(),
            stamp + milliseconds(5));
  const v4l2_buffer at_end =
      picture_at(seconds(99), milliseconds(500),
                 V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF);
  EXPECT_EQ(capture_time_of(system, at_end, exposure).time_since_epoch(), stamp - milliseconds(5));
  EXPECT_EQ(capture_time_of(system, at_end, nanoseconds(0)).time_since_epoch(), stamp);
}

TEST(V4l2Clock, UsesTheTimeOfFetchingWithoutAMonotonicStamp) {
  FakeV4l2 system;
  const v4l2_buffer unknown =
      picture_at(seconds(3), milliseconds(0), V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN);
  EXPECT_EQ(capture_time_of(system, unknown, milliseconds(10)).time_since_epoch(),
            seconds(1'700'000'100) - milliseconds(5));
}

}  // namespace
}  // namespace nadir::vision
