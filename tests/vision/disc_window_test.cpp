#include "vision/disc_window.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

struct PlainSums {
  double weight = 0.0;
  double weight_u = 0.0;
  double weight_v = 0.0;
  double edge_moment_px2 = 0.0;
  double weight_reach = 0.0;  // sum of weight * |offset|: what a relative error of u, v refers to
};

/// The same sums, written down from their definition: one pixel at a time, in double precision,
/// over the whole image.
PlainSums plain_sums(const cv::Mat& bgr, const DiscWindow& w, int first_row) {
  const Eigen::Vector3d difference = w.difference.cast<double>();
  const double outer = static_cast<double>(w.radius_px) + 1.1;
  const double inner = outer - 0.8;
  PlainSums sums;
  for (int v = first_row; v < bgr.rows; v += w.row_step) {
    for (int u = 0; u < bgr.cols; ++u) {
      const Eigen::Vector2d offset = PixelPoint(u, v) - w.centre;
      const double distance2 = (w.to_round.cast<double>() * offset).squaredNorm();
      const double taper =
          std::clamp((outer * outer - distance2) / (outer * outer - inner * inner), 0.0, 1.0);
      const auto& pixel = bgr.at<cv::Vec3b>(v, u);
      const Eigen::Vector3d value =
          Eigen::Vector3d(pixel[0], pixel[1], pixel[2]) - w.surroundings.cast<double>();
      const double share = value.dot(w.share_of.cast<double>());
      const double along = value.dot(difference) / difference.squaredNorm();
      const double off_line2 = (value - along * difference).squaredNorm();
      const double own =
          std::clamp(2.0 - off_line2 / (difference.squaredNorm() * 0.35 * 0.35), 0.0, 1.0);
      const double lit =
          std::clamp(1.0 + w.slope_u * offset.x() + w.slope_v * offset.y(), 0.3, 1.7);
      const double limited = (share / lit - w.limits.low) / (w.limits.high - w.limits.low);
      const double weight = taper * own * std::clamp(limited, 0.0, 1.0);
      sums.weight += weight;
      sums.weight_u += weight * offset.x();
      sums.weight_v += weight * offset.y();
      sums.weight_reach += weight * offset.norm();
      if (limited >= 0.0 && limited <= 1.0) sums.edge_moment_px2 += taper * taper * distance2;
    }
  }
  return sums;
}

/// A picture that owns exactly width * height * 3 bytes: a sanitizer sees every byte beyond.
struct ExactPicture {
  ExactPicture(int width_px, int height_px, std::uint64_t seed)
      : bytes(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 3),
        bgr(height_px, width_px, CV_8UC3, bytes.data()) {
    RandomStream random(seed);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  }
  std::vector<std::uint8_t> bytes;
  cv::Mat bgr;
};

DiscWindow window_at(double u_px, double v_px, float radius_px) {
  DiscWindow w;
  w.centre = {u_px, v_px};
  w.radius_px = radius_px;
  w.to_round = Eigen::Matrix2f::Identity();
  w.surroundings = Bgr(41.0F, 60.0F, 52.0F);
  w.difference = Bgr(150.0F, 90.0F, 120.0F);
  w.share_of = w.difference / w.difference.squaredNorm();
  w.limits = {0.1013F, 0.6029F};  // no pixel's share is exactly a limit
  return w;
}

void expect_plain_sums(const cv::Mat& bgr, const DiscWindow& w, int first_row = 0) {
  const WeightSums fast = sum_weights(bgr, w);
  const PlainSums plain = plain_sums(bgr, w, first_row);
  ASSERT_GT(plain.weight, 0.5);
  EXPECT_NEAR(fast.weight, plain.weight, 1e-4 * plain.weight);
  EXPECT_NEAR(fast.weight_u, plain.weight_u, 1e-4 * plain.weight_reach);
  EXPECT_NEAR(fast.weight_v, plain.weight_v, 1e-4 * plain.weight_reach);
  EXPECT_NEAR(fast.edge_moment_px2, plain.edge_moment_px2, 1e-4 * plain.edge_moment_px2 + 1e-3);
}

TEST(DiscWindow, SumsAreThoseOfAPlainLoop) {
  const ExactPicture picture(67, 45, 8);
  for (const float radius_px : {1.2F, 2.0F, 3.3F, 5.0F, 8.7F, 15.0F}) {
    for (const double shift_px : {0.0, 0.25, 0.5, 0.8}) {
      SCOPED_TRACE(testing::Message() << "radius " << radius_px << ", shift " << shift_px);
      expect_plain_sums(picture.bgr, window_at(30.0 + shift_px, 22.0 + 0.7 * shift_px, radius_px));
    }
  }
}

TEST(DiscWindow, SumsHoldAcrossASlopeOfLight) {
  const ExactPicture picture(67, 45, 2);
  DiscWindow w = window_at(31.3, 21.8, 9.0F);
  w.slope_u = 0.11F;  // reaches the limits of the light within the window
  w.slope_v = -0.04F;
  expect_plain_sums(picture.bgr, w);
}

// Shares need not be told along the line between the two colours.
TEST(DiscWindow, SumsWithATurnedShareFunction) {
  const ExactPicture picture(67, 45, 7);
  DiscWindow w = window_at(31.3, 21.8, 9.0F);
  w.share_of = Bgr(0.011F, -0.004F, -0.001F);
  w.share_of /= w.share_of.dot(w.difference);
  expect_plain_sums(picture.bgr, w);
}

TEST(DiscWindow, SumsOfEverySecondRow) {
  const ExactPicture picture(67, 45, 3);
  DiscWindow w = window_at(31.3, 21.8, 9.0F);
  w.row_step = 2;
  const int first_row = static_cast<int>(std::ceil(21.8 - (9.0 + 1.1)));
  expect_plain_sums(picture.bgr, w, first_row);
}

// A tilted camera shows discs as ellipses with any axes, also mirrored.
TEST(DiscWindow, SumsOfAnEllipseInAnyDirection) {
  const ExactPicture picture(67, 61, 4);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Rotation2Df turn(static_cast<float>(i * M_PI / 12.0));
    const float stretch = 1.35F;
    DiscWindow w = window_at(33.4, 29.7, 11.0F);
    w.to_round = turn * Eigen::Vector2f(stretch, 1.0F / stretch).asDiagonal() * turn.inverse();
    if (i % 2 == 1) w.to_round.row(1) *= -1.0F;
    SCOPED_TRACE(i);
    expect_plain_sums(picture.bgr, w);
  }
}

// Windows that touch and cross every border, to the last row and column; no byte beyond is read
// (the sanitizers' run sees that) and none is made up.
TEST(DiscWindow, SumsAtTheBordersCountOnlyPixelsOfTheImage) {
  for (const int width_px : {21, 24, 29, 32}) {
    const ExactPicture picture(width_px, 19, 5);
    for (const double u_px :
         {0.0, 4.0, 5.2, 11.0, width_px - 6.0, width_px - 5.0, width_px - 1.0}) {
      for (const double v_px : {0.0, 4.0, 9.3, 14.0, 18.0}) {
        SCOPED_TRACE(testing::Message() << width_px << " wide, at " << u_px << " " << v_px);
        expect_plain_sums(picture.bgr, window_at(u_px, v_px, 4.0F));
        DiscWindow dark = window_at(u_px, v_px, 4.0F);  // black would be a full share of the disc
        dark.surroundings = Bgr(200.0F, 200.0F, 200.0F);
        dark.difference = Bgr(-180.0F, -170.0F, -175.0F);
        dark.share_of = dark.difference / dark.difference.squaredNorm();
        expect_plain_sums(picture.bgr, dark);
      }
    }
  }
}

TEST(DiscWindow, ATinyImageIsSummedWhole) {
  const ExactPicture picture(3, 2, 6);
  expect_plain_sums(picture.bgr, window_at(1.0, 0.5, 6.0F));
}

TEST(DiscWindow, InsideSharesFindALinearSlope) {
  cv::Mat bgr(41, 41, CV_8UC3);
  for (int v = 0; v < 41; ++v) {
    for (int u = 0; u < 41; ++u) {
      const double share = 1.0 + 0.010 * (u - 20) - 0.006 * (v - 20);
      bgr.at<cv::Vec3b>(v, u) = {static_cast<uchar>(std::lround(41.0 + 150.0 * share)),
                                 static_cast<uchar>(std::lround(60.0 + 90.0 * share)),
                                 static_cast<uchar>(std::lround(52.0 + 120.0 * share))};
    }
  }
  const InsideShares inside = inside_shares(bgr, window_at(20.0, 20.0, 12.0F));
  const double deep_px = 12.0 - 2.2;
  EXPECT_NEAR(inside.count, M_PI * deep_px * deep_px, 12.0);
  EXPECT_NEAR(inside.mean, 1.0, 0.003);
  EXPECT_NEAR(inside.slope_u, 0.010, 3e-4);
  EXPECT_NEAR(inside.slope_v, -0.006, 3e-4);
  EXPECT_LT(inside.scatter, 1e-5);  // rounding only
}

}  // namespace
}  // namespace nadir::vision
