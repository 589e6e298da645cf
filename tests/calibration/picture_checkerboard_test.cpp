// Checkerboards drawn through a lens whose pixels are known.

#include "calibration/program/picture_checkerboard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/calibration/picture_drawing.h"

namespace nadir::calibration {
namespace {

constexpr double kSquare_m = 0.05;

/// 400x320 px of 2.5 mm with barrel distortion.
Eigen::Vector2d lens(const vision::PixelPoint& pixel) {
  const Eigen::Vector2d n = (pixel - vision::PixelPoint(200.0, 160.0)) / 200.0;
  const Eigen::Vector2d straight = n * (1.0 + 0.06 * n.squaredNorm());
  return {0.5 * straight.x(), -0.5 * straight.y()};
}

/// Distance of each true corner to the nearest one found, RMS; every corner must have its own.
double corner_rms_px(const BoardCorners& board, const Eigen::Vector2d& origin_m,
                     double direction_rad, int columns, int rows) {
  const Eigen::Vector2d along(std::cos(direction_rad), std::sin(direction_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  double squares = 0.0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto pixel =
          pixel_of(lens, origin_m + kSquare_m * (column * along + row * across), {200.0, 160.0});
      double nearest = 1e9;
      for (const auto& corner : board.corners) nearest = std::min(nearest, (corner - pixel).norm());
      squares += nearest * nearest / (columns * rows);
    }
  }
  return std::sqrt(squares);
}

TEST(Checkerboard, IsFoundAndItsCornersToAFewHundredthsOfAPixel) {
  for (const double direction_rad : {0.0, 0.3, 1.2}) {
    const Eigen::Vector2d middle = 0.5 * kSquare_m * Eigen::Vector2d(6, 4);
    Eigen::Matrix2d turn;
    turn << std::cos(direction_rad), -std::sin(direction_rad), std::sin(direction_rad),
        std::cos(direction_rad);
    const Eigen::Vector2d origin_m = -turn * middle;
    const auto picture = drawn_picture(
        {400, 320}, lens, checkerboard(origin_m, direction_rad, kSquare_m, 7, 5), 11, 12);
    const auto board = find_checkerboard(picture, {7, 5});
    ASSERT_TRUE(board) << direction_rad;
    ASSERT_EQ(board->corners.size(), 35U);
    EXPECT_LT(corner_rms_px(*board, origin_m, direction_rad, 7, 5), 0.06) << direction_rad;
    // Neighbours are neighbours: one square apart.
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column + 1 < 7; ++column) {
        const double distance_m =
            (lens(board->at(column, row)) - lens(board->at(column + 1, row))).norm();
        EXPECT_NEAR(distance_m, kSquare_m, 0.002);
      }
    }
    // The same board asked for with its sides the other way round.
    const auto other = find_checkerboard(picture, {5, 7});
    ASSERT_TRUE(other);
    EXPECT_EQ(other->size.columns, 5);
  }
}

TEST(Checkerboard, IsNotFoundWhereItIsNot) {
  const auto shade = checkerboard({-0.15, -0.1}, 0.0, kSquare_m, 7, 5);
  const auto picture = drawn_picture({400, 320}, lens, shade, 12);
  EXPECT_FALSE(find_checkerboard(picture, {8, 5}));
  EXPECT_FALSE(find_checkerboard(picture, {6, 5}));
  const auto hidden = drawn_picture(
      {400, 320}, lens,
      [&](const Eigen::Vector2d& place) {
        return (place - Eigen::Vector2d(-0.15, -0.1)).norm() < 0.03 ? 150.0 : shade(place);
      },
      13);
  EXPECT_FALSE(find_checkerboard(hidden, {7, 5}));
  EXPECT_FALSE(find_checkerboard(cv::Mat(50, 60, CV_8UC3, cv::Scalar(90, 90, 90)), {7, 5}));
}

}  // namespace
}  // namespace nadir::calibration
