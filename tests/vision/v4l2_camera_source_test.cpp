#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <optional>

#include "tests/vision/fake_v4l2.h"
#include "vision/sources/v4l2_camera.h"

namespace nadir::vision {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

class V4l2CameraSource : public testing::Test {
 protected:
  void feed(std::uint32_t sequence, std::uint8_t grey = 50, std::uint32_t flags = 0) {
    const nanoseconds stamp = seconds(90) + sequence * milliseconds(33);
    system_.pictures.push_back({std::vector<std::uint8_t>(8, grey), sequence, stamp,
                                flags | V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC});
  }
  V4l2Camera& camera() {
    if (!camera_) camera_.emplace("/dev/video0", request_, system_);
    return *camera_;
  }
  ReadResult read() { return camera().read(frame_); }
  /// Reads on until something else than kUnavailable comes; gives up after many calls.
  ReadResult read_until_available() {
    for (int i = 0; i < 1000; ++i) {
      ReadResult result = read();
      if (result.status != ReadStatus::kUnavailable) return result;
    }
    return {};
  }

  FakeV4l2 system_;
  V4l2Request request_;
  std::optional<V4l2Camera> camera_;
  Frame frame_;
};

TEST_F(V4l2CameraSource, DeliversPicturesWithTheDriversTime) {
  feed(10, 77);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  EXPECT_TRUE(camera().is_live());
  EXPECT_EQ(frame_.number, 0U);
  EXPECT_EQ(frame_.image.size(), cv::Size(4, 2));
  EXPECT_EQ(frame_.image.at<cv::Vec3b>(1, 3), cv::Vec3b(77, 77, 77));
  EXPECT_EQ(frame_.capture_time.time_since_epoch(), seconds(1'700'000'090) + milliseconds(330));
  const uchar* const buffer = frame_.image.data;
  feed(11, 78);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  EXPECT_EQ(frame_.number, 1U);
  EXPECT_EQ(frame_.image.data, buffer);
}

TEST_F(V4l2CameraSource, TakesOffHalfTheExposureAtTheEndOfTheFrame) {
  system_.exposure_100us = 40;  // 4 ms
  feed(0);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  EXPECT_EQ(frame_.capture_time.time_since_epoch(), seconds(1'700'000'090) - milliseconds(2));
}

TEST_F(V4l2CameraSource, TakesTheNewestPictureAndLeavesGapsForLostOnes) {
  feed(5);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  feed(6, 60);
  feed(7, 70);
  feed(9, 90);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  EXPECT_EQ(frame_.number, 4U);
  EXPECT_EQ(frame_.image.at<cv::Vec3b>(0, 0)[0], 90);
  EXPECT_EQ(system_.queued_buffers.size(), 4U) << "every buffer is back with the driver";
}

TEST_F(V4l2CameraSource, CountsOverTheWrapOfTheDriversCountAndWithoutOne) {
  feed(0xFFFFFFFF);
  read();
  feed(1);
  read();
  EXPECT_EQ(frame_.number, 2U);
  feed(1);  // a driver that does not count
  read();
  EXPECT_EQ(frame_.number, 3U);
  feed(0);  // one that starts over
  read();
  EXPECT_EQ(frame_.number, 4U);
}

TEST_F(V4l2CameraSource, SkipsDamagedAndShortPictures) {
  feed(0, 50, V4L2_BUF_FLAG_ERROR);
  const ReadResult damaged = read();
  EXPECT_EQ(damaged.status, ReadStatus::kSkipped);
  EXPECT_EQ(damaged.message, "v4l2:/dev/video0: picture 0 is incomplete; the frame is skipped");
  feed(1);
  system_.pictures.back().bytes.resize(5);
  EXPECT_EQ(read().status, ReadStatus::kSkipped);
  feed(2);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  EXPECT_EQ(frame_.number, 2U);
  EXPECT_EQ(system_.queued_buffers.size(), 4U);
}

TEST_F(V4l2CameraSource, KeepsTryingWithGrowingIntervals) {
  system_.is_plugged = false;
  for (int i = 0; i < 60; ++i) {
    const nanoseconds before = system_.monotonic;
    const ReadResult result = read();
    EXPECT_EQ(result.status, ReadStatus::kUnavailable);
    EXPECT_EQ(result.message,
              "v4l2:/dev/video0: cannot be opened: No such file or directory; nadir keeps trying");
    EXPECT_LE(system_.monotonic - before, milliseconds(100));
  }
  const auto& times = system_.open_times;
  ASSERT_GE(times.size(), 7U);
  const std::vector<milliseconds> expected{milliseconds(100),  milliseconds(200),
                                           milliseconds(400),  milliseconds(800),
                                           milliseconds(1000), milliseconds(1000)};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(times[i + 1] - times[i], expected[i]) << i;
  }
  EXPECT_EQ(system_.open_descriptors, 0);
}

TEST_F(V4l2CameraSource, ComesBackAfterItWasUnplugged) {
  feed(41);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  system_.is_plugged = false;
  const ReadResult lost = read();
  EXPECT_EQ(lost.status, ReadStatus::kUnavailable);
  EXPECT_EQ(lost.message, "v4l2:/dev/video0: the camera went away; nadir keeps trying");
  EXPECT_EQ(system_.open_descriptors, 0);
  EXPECT_EQ(system_.open_mappings, 0);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(read().status, ReadStatus::kUnavailable);

  system_.is_plugged = true;
  feed(0, 99);  // the driver counts from 0 again
  ASSERT_EQ(read_until_available().status, ReadStatus::kFrame);
  EXPECT_EQ(frame_.number, 1U);
  EXPECT_EQ(frame_.image.at<cv::Vec3b>(0, 0)[0], 99);
  EXPECT_EQ(system_.opened, 2);
  EXPECT_EQ(system_.open_mappings, 4);
}

TEST_F(V4l2CameraSource, ClosesEverythingAtItsEnd) {
  feed(0);
  read();
  camera_.reset();
  EXPECT_EQ(system_.open_descriptors, 0);
  EXPECT_EQ(system_.open_mappings, 0);
  EXPECT_FALSE(system_.is_streaming);
}

TEST_F(V4l2CameraSource, OpensASilentCameraAgain) {
  feed(0);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  const ReadResult waiting = read();
  EXPECT_EQ(waiting.status, ReadStatus::kUnavailable);
  EXPECT_THAT(waiting.message, testing::HasSubstr("no picture for 0."));
  for (int i = 0; i < 100 && system_.opened == 1; ++i) read();
  EXPECT_EQ(system_.opened, 2);
}

TEST_F(V4l2CameraSource, WaitsQuietlyForASlowCamera) {
  system_.formats = {{V4L2_PIX_FMT_GREY, 1.0}};
  feed(0);
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  const nanoseconds before = system_.monotonic;
  EXPECT_EQ(read().status, ReadStatus::kUnavailable);
  EXPECT_GE(system_.monotonic - before, seconds(3)) << "three intervals of a 1 Hz camera";
}

TEST_F(V4l2CameraSource, ChoosesTheBestFormatThatIsFastEnough) {
  system_.formats = {
      {V4L2_PIX_FMT_GREY, 60.0}, {V4L2_PIX_FMT_MJPEG, 60.0}, {V4L2_PIX_FMT_YUYV, 30.0}};
  request_.rate_hz = 30.0;
  read();
  EXPECT_EQ(system_.chosen_fourcc, V4L2_PIX_FMT_YUYV);
}

TEST_F(V4l2CameraSource, PrefersCompressedPicturesToAnIdleRate) {
  system_.formats = {{V4L2_PIX_FMT_YUYV, 10.0}, {V4L2_PIX_FMT_MJPEG, 30.0}};
  read();
  EXPECT_EQ(system_.chosen_fourcc, V4L2_PIX_FMT_MJPEG);
}

TEST_F(V4l2CameraSource, TakesWhatTheCameraHasIfNothingSatisfies) {
  system_.formats = {{V4L2_PIX_FMT_MJPEG, 5.0}, {V4L2_PIX_FMT_BGR24, 5.0}};
  system_.has_free_size = false;
  request_ = {640, 480, 30.0};
  system_.pictures.push_back(
      {std::vector<std::uint8_t>(24, 9), 0, seconds(90), V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC});
  ASSERT_EQ(read().status, ReadStatus::kFrame);
  EXPECT_EQ(system_.chosen_fourcc, V4L2_PIX_FMT_BGR24);
  EXPECT_EQ(frame_.image.size(), cv::Size(4, 2)) << "the camera's answer counts";
}

TEST_F(V4l2CameraSource, SaysWhatTheDeviceRefuses) {
  const auto message_after_refusing = [this](std::uint32_t request, int code) {
    camera_.reset();
    system_.refuse = {{request, code}};
    return read().message;
  };
  EXPECT_THAT(message_after_refusing(VIDIOC_REQBUFS, EBUSY),
              testing::HasSubstr("gives no buffers: Device or resource busy"));
  EXPECT_THAT(message_after_refusing(VIDIOC_STREAMON, ENOSPC),
              testing::HasSubstr("does not start: No space left on device"));
  EXPECT_THAT(message_after_refusing(VIDIOC_QUERYCAP, ENOTTY),
              testing::HasSubstr("is no video device"));
  camera_.reset();
  system_.refuse.clear();
  system_.formats = {{V4L2_PIX_FMT_NV12}};
  EXPECT_THAT(read().message, testing::HasSubstr("offers no usable format (it has NV12)"));
  camera_.reset();
  system_.abilities = V4L2_CAP_VIDEO_OUTPUT;
  EXPECT_THAT(read().message, testing::HasSubstr("takes no pictures"));
  EXPECT_EQ(system_.open_descriptors, 0);
  EXPECT_EQ(system_.open_mappings, 0);
}

}  // namespace
}  // namespace nadir::vision
