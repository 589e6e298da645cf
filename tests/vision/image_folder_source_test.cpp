#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"
#include "tests/vision/test_pictures.h"
#include "vision/sources/image_folder.h"

namespace nadir::vision {
namespace {

using std::chrono::nanoseconds;

constexpr CaptureTime kStart{nanoseconds(1'700'000'000'000'000'000)};

class ImageFolderSource : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write_picture(const std::string& name, int index) const {
    ASSERT_TRUE(cv::imwrite(path(name), test_picture(32, 24, index)));
  }
  ImageFolder open() const { return ImageFolder(folder_.path(), 50.0, kStart); }
  std::string open_error() const {
    std::string line = input_error_line([this] { open(); });
    const std::size_t at = line.find(folder_.path().string());
    if (at != 0) return line;
    return line.substr(std::min(line.size(), folder_.path().string().size() + 1));
  }
  /// What is left of a file that was not written to its end.
  void cut(const std::string& name, std::uintmax_t removed_bytes) const {
    std::filesystem::resize_file(path(name),
                                 std::filesystem::file_size(path(name)) - removed_bytes);
  }

  ScratchFolder folder_;
};

TEST_F(ImageFolderSource, ReadsEveryKindOfPictureInTheOrderOfNames) {
  const std::vector<std::string> names{"a.png", "b.JPG", "c.bmp", "d.ppm", "e.tif", "f.jpeg"};
  for (std::size_t i = names.size(); i-- > 0;) write_picture(names[i], static_cast<int>(i));
  folder_.write("notes.txt", "not a picture");
  std::filesystem::create_directory(path("g.png"));
  ImageFolder source = open();
  EXPECT_EQ(source.frame_count(), names.size());
  EXPECT_FALSE(source.is_live());
  Frame frame;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ReadResult result = source.read(frame);
    ASSERT_EQ(result.status, ReadStatus::kFrame) << names[i] << result.message;
    EXPECT_EQ(frame.number, i);
    EXPECT_EQ(frame.image.type(), CV_8UC3);
    EXPECT_LT(cv::norm(frame.image, test_picture(32, 24, static_cast<int>(i)), cv::NORM_INF), 12)
        << names[i];
  }
  EXPECT_EQ(source.read(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(source.read(frame).status, ReadStatus::kEnd);
}

TEST_F(ImageFolderSource, SpacesFramesByTheRateWithoutATimesFile) {
  for (int i = 0; i < 3; ++i) write_picture(std::to_string(i) + ".png", i);
  ImageFolder source(folder_.path(), 30.0, kStart);
  Frame frame;
  const std::vector<std::int64_t> expected_ns{0, 33'333'333, 66'666'667};
  for (const std::int64_t since_start_ns : expected_ns) {
    ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
    EXPECT_EQ((frame.capture_time - kStart).count(), since_start_ns);
  }
}

TEST_F(ImageFolderSource, TakesCaptureTimesFromTheTimesFile) {
  write_picture("0.png", 0);
  write_picture("1.png", 1);
  folder_.write("times.csv",
                "file,capture_ns\n1.png,1700000000000000007\nframes/0.png,1700000000000000001\n");
  ImageFolder source = open();
  Frame frame;
  source.read(frame);
  EXPECT_EQ(frame.capture_time.time_since_epoch().count(), 1700000000000000001);
  source.read(frame);
  EXPECT_EQ(frame.capture_time.time_since_epoch().count(), 1700000000000000007);
}

TEST_F(ImageFolderSource, FindsTheTimesFileBesideAFolderCalledFrames) {
  std::filesystem::create_directory(path("frames"));
  write_picture("frames/0.png", 0);
  folder_.write("times.csv", "file,capture_ns\n0.png,42\n");
  Frame frame;
  ImageFolder source(folder_.path() / "frames/", 50.0, kStart);
  ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.capture_time.time_since_epoch().count(), 42);
}

TEST_F(ImageFolderSource, RefusesTimesFilesThatDoNotFit) {
  write_picture("0.png", 0);
  write_picture("1.png", 1);
  const auto error_of = [this](const std::string& rows) {
    folder_.write("times.csv", "file,capture_ns\n" + rows);
    return open_error();
  };
  EXPECT_EQ(error_of("0.png,1\n"),
            "times.csv: has no row for the image '1.png'; add the row or remove the image");
  EXPECT_EQ(error_of("0.png,1\n1.png,2\n2.png,3\n"),
            "times.csv:4:1: there is no image '2.png'; restore the image or remove the row");
  EXPECT_EQ(error_of("0.png,1\n0.png,2\n"),
            "times.csv:3:1: '0.png' again; it is already on line 2; remove one of the two");
  EXPECT_EQ(error_of("0.png,5\n1.png,5\n"),
            "times.csv:3:7: '1.png' was not taken after the image before it; name the images in "
            "the order of their capture times");
  EXPECT_EQ(error_of("0.png,1\n1.png,1.5\n"),
            "times.csv:3:7: capture_ns is '1.5'; write a whole number");
}

TEST_F(ImageFolderSource, SkipsPicturesThatCannotBeReadAndKeepsTheCount) {
  write_picture("0.png", 0);
  folder_.write("1.png", "this is no picture");
  write_picture("2.jpg", 2);
  cut("2.jpg", 40);
  write_picture("3.png", 3);
  cut("3.png", 20);
  folder_.write("4.png", "");
  write_picture("5.png", 5);
  ImageFolder source = open();
  Frame frame;
  EXPECT_EQ(source.read(frame).status, ReadStatus::kFrame);
  testing::internal::CaptureStderr();
  const std::vector<std::string> expected{"1.png: is damaged or not an image; the frame is skipped",
                                          "2.jpg: is incomplete; the frame is skipped",
                                          "3.png: is incomplete; the frame is skipped",
                                          "4.png: is incomplete; the frame is skipped"};
  for (const std::string& message : expected) {
    const ReadResult result = source.read(frame);
    EXPECT_EQ(result.status, ReadStatus::kSkipped);
    EXPECT_EQ(result.message, folder_.path().string() + "/" + message);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.number, 5U);
  EXPECT_EQ(frame.capture_time, kStart + std::chrono::milliseconds(100));
  EXPECT_EQ(cv::norm(frame.image, test_picture(32, 24, 5), cv::NORM_INF), 0.0);
}

TEST_F(ImageFolderSource, SkipsAPictureThatVanished) {
  write_picture("0.png", 0);
  ImageFolder source = open();
  std::filesystem::remove(path("0.png"));
  Frame frame;
  const ReadResult result = source.read(frame);
  EXPECT_EQ(result.status, ReadStatus::kSkipped);
  EXPECT_THAT(result.message, testing::EndsWith("0.png: cannot be read; the frame is skipped"));
}

TEST_F(ImageFolderSource, SkipsAPngThatIsDamagedInTheMiddle) {
  write_picture("0.png", 0);
  const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(path("0.png")) / 2);
  std::fstream stream(path("0.png"), std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(middle);
  stream.write("damage", 6);
  stream.close();
  ImageFolder source = open();
  Frame frame;
  EXPECT_EQ(source.read(frame).message,
            path("0.png") + ": is damaged or not an image; the frame is skipped");
}

TEST_F(ImageFolderSource, TurnsGreyAndTransparentPicturesIntoColour) {
  cv::imwrite(path("0.png"), cv::Mat(4, 4, CV_8UC1, cv::Scalar(77)));
  cv::imwrite(path("1.png"), cv::Mat(4, 4, CV_8UC4, cv::Scalar(1, 2, 3, 128)));
  cv::imwrite(path("2.png"), cv::Mat(4, 4, CV_16UC3, cv::Scalar(256, 512, 768)));
  ImageFolder source = open();
  Frame frame;
  for (const cv::Vec3b& pixel : {cv::Vec3b(77, 77, 77), cv::Vec3b(1, 2, 3), cv::Vec3b(1, 2, 3)}) {
    ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
    EXPECT_EQ(frame.image.type(), CV_8UC3);
    EXPECT_EQ(frame.image.at<cv::Vec3b>(2, 2), pixel);
  }
}

TEST_F(ImageFolderSource, RefusesFoldersWithoutPictures) {
  EXPECT_EQ(input_error_line([this] { open(); }),
            folder_.path().string() +
                ": holds no image; put png, jpg, jpeg, bmp, ppm or tif files into it");
  std::filesystem::create_directory(path("frames"));
  EXPECT_EQ(input_error_line([this] { open(); }),
            folder_.path().string() + ": holds no image; did you mean '" + path("frames") + "'?");
}

}  // namespace
}  // namespace nadir::vision
