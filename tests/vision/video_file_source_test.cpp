#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"
#include "tests/vision/test_pictures.h"
#include "vision/sources/video_file.h"

namespace nadir::vision {
namespace {

constexpr CaptureTime kStart{std::chrono::nanoseconds(1'700'000'000'000'000'000)};
constexpr int kFrames = 6;
constexpr double kContainerRateHz = 25.0;

class VideoFileSource : public testing::Test {
 protected:
  void SetUp() override {
    file_ = folder_.path() / "clip.avi";
    cv::VideoWriter writer(file_.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           kContainerRateHz, cv::Size(64, 48));
    if (!writer.isOpened()) {
      GTEST_SKIP() << "OpenCV's video back ends cannot write an MJPG file here";
    }
    for (int i = 0; i < kFrames; ++i) writer.write(test_picture(64, 48, i));
  }

  ScratchFolder folder_;
  std::filesystem::path file_;
};

TEST_F(VideoFileSource, ReadsEveryFrameInOrder) {
  VideoFile source(file_, 100.0, kStart);
  EXPECT_FALSE(source.is_live());
  Frame frame;
  for (int i = 0; i < kFrames; ++i) {
    const ReadResult result = source.read(frame);
    ASSERT_EQ(result.status, ReadStatus::kFrame) << i;
    EXPECT_EQ(result.message, "");
    EXPECT_EQ(frame.number, static_cast<std::uint64_t>(i));
    EXPECT_EQ(frame.image.type(), CV_8UC3);
    // The neighbouring pictures differ by 20 grey levels in green.
    EXPECT_LT(cv::norm(frame.image, test_picture(64, 48, i), cv::NORM_L1) / (64 * 48 * 3), 4.0);
  }
  EXPECT_EQ(source.read(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(source.read(frame).status, ReadStatus::kEnd);
}

TEST_F(VideoFileSource, TakesCaptureTimesFromTheContainer) {
  VideoFile source(file_, 100.0, kStart);  // the file's 25 Hz count, not the 100 Hz
  Frame frame;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
    EXPECT_EQ(frame.capture_time, kStart + i * std::chrono::milliseconds(40)) << i;
  }
}

TEST_F(VideoFileSource, UsesTheImageBufferAgain) {
  VideoFile source(file_, 25.0, kStart);
  Frame frame;
  source.read(frame);
  const uchar* const buffer = frame.image.data;
  source.read(frame);
  EXPECT_EQ(frame.image.data, buffer);
}

TEST_F(VideoFileSource, RefusesWhatIsNoVideo) {
  const auto text = folder_.write("notes.avi", "not a video");
  EXPECT_EQ(input_error_line([&] { VideoFile(text, 25.0, kStart); }),
            text.string() +
                ": is not a video that can be read; name a video file, or a folder of "
                "images");
  const auto missing = folder_.path() / "missing.avi";
  EXPECT_EQ(input_error_line([&] { VideoFile(missing, 25.0, kStart); }),
            missing.string() + ": cannot be opened; check the path and the permissions");
}

}  // namespace
}  // namespace nadir::vision
