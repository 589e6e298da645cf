#include "vision/sources/open_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"
#include "tests/vision/test_pictures.h"

namespace nadir::vision {
namespace {

const std::string kPossible =
    "; possible are a folder of images, a video file, v4l2:/dev/video0 and synthetic:SCENE.yaml";

std::string error_of(const std::string& source) {
  return input_error_line([&] { open_source(source); });
}

TEST(OpenSource, OpensAFolder) {
  const ScratchFolder folder;
  cv::imwrite((folder.path() / "0.png").string(), test_picture(8, 8, 0));
  SourceOptions options;
  options.start_time = CaptureTime(std::chrono::seconds(5));
  const auto source = open_source(folder.path().string(), options);
  Frame frame;
  ASSERT_EQ(source->read(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.capture_time, options.start_time);
}

TEST(OpenSource, OpensAVideoEvenWithAColonInItsName) {
  const ScratchFolder folder;
  const std::string file = (folder.path() / "12:30.avi").string();
  {
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0,
                           cv::Size(64, 48));
    if (!writer.isOpened()) GTEST_SKIP() << "OpenCV cannot write an MJPG file here";
    writer.write(test_picture(64, 48, 0));
  }
  Frame frame;
  EXPECT_EQ(open_source(file)->read(frame).status, ReadStatus::kFrame);
}

TEST(OpenSource, OpensACameraThatIsNotThere) {
  const auto camera = open_source("v4l2:/dev/video-that-never-was");
  EXPECT_TRUE(camera->is_live());
  Frame frame;
  for (int i = 0; i < 2; ++i) {
    const ReadResult result = camera->read(frame);
    EXPECT_EQ(result.status, ReadStatus::kUnavailable);
    EXPECT_EQ(result.message,
              "v4l2:/dev/video-that-never-was: cannot be opened: No such file or directory; nadir "
              "keeps trying");
  }
}

TEST(OpenSource, SaysThatAFileIsNoCamera) {
  const ScratchFolder folder;
  const std::string file = folder.write("video0", "no device").string();
  Frame frame;
  EXPECT_EQ(open_source("v4l2:" + file)->read(frame).message,
            "v4l2:" + file + ": is no video device; nadir keeps trying");
}

/// A scene of a few pixels: floor and sensor noise.
std::string small_scene(const ScratchFolder& folder) {
  return "synthetic:" +
         folder.write("scene.yaml", "camera: {width_px: 32, height_px: 24, rate_hz: 20}\n")
             .string();
}

TEST(OpenSource, OpensASyntheticScene) {
  const ScratchFolder folder;
  const std::string scene = small_scene(folder);
  Frame frame;
  Frame again;
  Frame other;
  const auto source = open_source(scene);
  EXPECT_FALSE(source->is_live());
  ASSERT_EQ(source->read(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.number, 0U);
  EXPECT_EQ(frame.image.size(), cv::Size(32, 24));
  ASSERT_EQ(open_source(scene)->read(again).status, ReadStatus::kFrame);
  EXPECT_EQ(cv::norm(frame.image, again.image, cv::NORM_INF), 0.0);
  SourceOptions options;
  options.seed = 2;
  ASSERT_EQ(open_source(scene, options)->read(other).status, ReadStatus::kFrame);
  EXPECT_GT(cv::norm(frame.image, other.image, cv::NORM_INF), 0.0);
}

TEST(OpenSource, RunsASyntheticSceneInRealTime) {
  const ScratchFolder folder;
  SourceOptions options;
  options.synthetic_in_real_time = true;
  EXPECT_TRUE(open_source(small_scene(folder), options)->is_live());
}

TEST(OpenSource, SaysThatASceneIsMissing) {
  EXPECT_EQ(error_of("synthetic:no_scene.yaml"),
            "no_scene.yaml: cannot be opened: No such file or directory; check the path and the "
            "permissions");
}

TEST(OpenSource, ListsWhatIsPossible) {
  EXPECT_EQ(error_of("rtsp2:foo"), "rtsp2:foo: unknown source scheme 'rtsp2'" + kPossible);
  EXPECT_EQ(error_of("no/such/folder"), "no/such/folder: no such file or folder" + kPossible);
  EXPECT_EQ(error_of("v4l2:"), "v4l2:: nothing stands behind the colon" + kPossible);
  EXPECT_EQ(error_of(""), "the source is empty" + kPossible);
}

TEST(OpenSource, RefusesRatesThatAreNotPositive) {
  for (const double rate_hz : {0.0, -1.0, std::nan("")}) {
    SourceOptions options;
    options.rate_hz = rate_hz;
    EXPECT_THAT(input_error_line([&] { open_source("v4l2:/dev/video0", options); }),
                testing::HasSubstr("the rate is not above 0 Hz"));
  }
}

}  // namespace
}  // namespace nadir::vision
