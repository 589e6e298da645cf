#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "tests/vision/test_pictures.h"
#include "vision/sources/v4l2_pixels.h"

namespace nadir::vision {
namespace {

/// The mosaic that a sensor under a filter of these four colours (first row, second row) makes of a
/// plain colour.
std::vector<std::uint8_t> mosaic(const std::string& filter, int width_px, int height_px,
                                 const cv::Vec3b& bgr) {
  std::vector<std::uint8_t> bytes;
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      const char colour = filter[2 * (v % 2) + u % 2];
      bytes.push_back(bgr[colour == 'B' ? 0 : colour == 'G' ? 1 : 2]);
    }
  }
  return bytes;
}

TEST(V4l2Pixels, KnowsTheFourMosaics) {
  const cv::Vec3b colour(30, 120, 220);
  const std::vector<std::pair<std::uint32_t, std::string>> cases{{V4L2_PIX_FMT_SRGGB8, "RGGB"},
                                                                 {V4L2_PIX_FMT_SGRBG8, "GRBG"},
                                                                 {V4L2_PIX_FMT_SGBRG8, "GBRG"},
                                                                 {V4L2_PIX_FMT_SBGGR8, "BGGR"}};
  for (const auto& [fourcc, filter] : cases) {
    cv::Mat image;
    ASSERT_EQ(convert_picture(mosaic(filter, 8, 6, colour), {fourcc, 8, 6, 8}, image),
              DecodeStatus::kDecoded);
    EXPECT_EQ(image.at<cv::Vec3b>(3, 4), colour) << filter;
  }
}

TEST(V4l2Pixels, HonoursPaddedLines) {
  // 2 x 2 pixels, 3 bytes each, lines of 8 bytes; the last line's padding may be absent.
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6, 99, 99, 7, 8, 9, 10, 11, 12};
  cv::Mat image;
  ASSERT_EQ(convert_picture(bytes, {V4L2_PIX_FMT_BGR24, 2, 2, 8}, image), DecodeStatus::kDecoded);
  EXPECT_EQ(image.at<cv::Vec3b>(1, 0), cv::Vec3b(7, 8, 9));
  ASSERT_EQ(convert_picture(bytes, {V4L2_PIX_FMT_RGB24, 2, 2, 8}, image), DecodeStatus::kDecoded);
  EXPECT_EQ(image.at<cv::Vec3b>(1, 1), cv::Vec3b(12, 11, 10));
}

TEST(V4l2Pixels, ConvertsLumaAndChroma) {
  // Y = 16 + 219 * 0.5 and neutral chroma is mid grey in the video range (BT.601).
  std::vector<std::uint8_t> yuyv;
  std::vector<std::uint8_t> uyvy;
  for (int i = 0; i < 8; ++i) {
    yuyv.insert(yuyv.end(), {126, 128});
    uyvy.insert(uyvy.end(), {128, 126});
  }
  for (const auto& [bytes, fourcc] : {std::pair(yuyv, std::uint32_t{V4L2_PIX_FMT_YUYV}),
                                      std::pair(uyvy, std::uint32_t{V4L2_PIX_FMT_UYVY})}) {
    cv::Mat image;
    ASSERT_EQ(convert_picture(bytes, {fourcc, 4, 2, 8}, image), DecodeStatus::kDecoded);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(image.at<cv::Vec3b>(1, 2)[channel], 128, 1);
    }
  }
}

TEST(V4l2Pixels, ConvertsGrey) {
  cv::Mat image;
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6};
  ASSERT_EQ(convert_picture(bytes, {V4L2_PIX_FMT_GREY, 3, 2, 0}, image), DecodeStatus::kDecoded);
  EXPECT_EQ(image.at<cv::Vec3b>(1, 1), cv::Vec3b(5, 5, 5));
}

TEST(V4l2Pixels, DecodesCompressedPicturesWithPadding) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", test_picture(32, 16, 1), bytes);
  bytes.resize(bytes.size() + 100, 0);  // drivers hand over whole packets
  cv::Mat image;
  ASSERT_EQ(convert_picture(bytes, {V4L2_PIX_FMT_MJPEG, 32, 16, 0}, image), DecodeStatus::kDecoded);
  EXPECT_LT(cv::norm(image, test_picture(32, 16, 1), cv::NORM_INF), 12);
}

TEST(V4l2Pixels, RefusesTooFewBytes) {
  cv::Mat image;
  const std::vector<std::uint8_t> bytes(11);
  EXPECT_EQ(convert_picture(bytes, {V4L2_PIX_FMT_BGR24, 2, 2, 6}, image),
            DecodeStatus::kIncomplete);
  EXPECT_EQ(convert_picture({}, {V4L2_PIX_FMT_MJPEG, 2, 2, 0}, image), DecodeStatus::kIncomplete);
  EXPECT_EQ(convert_picture(bytes, {V4L2_PIX_FMT_NV12, 2, 2, 2}, image), DecodeStatus::kNotAnImage);
}

TEST(V4l2Pixels, NamesFormats) { EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_YUYV), "YUYV"); }

}  // namespace
}  // namespace nadir::vision
