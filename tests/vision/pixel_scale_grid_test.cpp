#include "vision/pixel_scale_grid.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace nadir::vision {
namespace {

/// A Jacobian that is linear in the pixel, so that bilinear interpolation must be exact.
Eigen::Matrix2d linear_jacobian(const PixelPoint& pixel) {
  Eigen::Matrix2d jacobian;
  jacobian << 0.004 + 1e-6 * pixel.x(), 2e-7 * pixel.y(), -1e-7 * pixel.x(),
      -0.005 - 2e-6 * pixel.y();
  return jacobian;
}

TEST(PixelScaleGrid, IsExactForALinearJacobian) {
  const PixelScaleGrid grid(640, 480, linear_jacobian);
  for (const PixelPoint& pixel : {PixelPoint(0, 0), PixelPoint(639, 479), PixelPoint(101.3, 77.7),
                                  PixelPoint(32, 64), PixelPoint(620.5, 3.25)}) {
    EXPECT_TRUE(grid.metres_per_pixel(pixel).isApprox(linear_jacobian(pixel), 1e-12))
        << pixel.transpose();
    EXPECT_TRUE((grid.pixels_per_metre(pixel) * linear_jacobian(pixel))
                    .isApprox(Eigen::Matrix2d::Identity(), 1e-12));
  }
}

TEST(PixelScaleGrid, TakesTheBorderOutsideTheImage) {
  const PixelScaleGrid grid(640, 480, linear_jacobian);
  EXPECT_TRUE(grid.metres_per_pixel({-50, 700}).isApprox(linear_jacobian({0, 479}), 1e-12));
  EXPECT_TRUE(grid.metres_per_pixel({5000, -1}).isApprox(linear_jacobian({639, 0}), 1e-12));
}

TEST(PixelScaleGrid, ReportsTheScalesExtremes) {
  const auto jacobian = [](const PixelPoint& pixel) -> Eigen::Matrix2d {
    return Eigen::Matrix2d::Identity() * (0.002 + 1e-5 * pixel.x());
  };
  const PixelScaleGrid grid(65, 33, jacobian);  // nodes at u = 0, 32, 64
  EXPECT_NEAR(grid.largest_pixels_per_metre(), 1.0 / 0.002, 1e-9);
  EXPECT_NEAR(grid.smallest_pixels_per_metre(), 1.0 / (0.002 + 64e-5), 1e-9);
}

TEST(PixelScaleGrid, CoversImagesSmallerThanOneCell) {
  const PixelScaleGrid grid(1, 3, linear_jacobian);
  EXPECT_TRUE(grid.metres_per_pixel({0, 2}).isApprox(linear_jacobian({0, 2}), 1e-12));
}

TEST(PixelScaleGrid, RefusesSizesThatAreNotPositive) {
  EXPECT_THROW(PixelScaleGrid(0, 10, linear_jacobian), std::invalid_argument);
  EXPECT_THROW(PixelScaleGrid(10, 10, linear_jacobian, 0), std::invalid_argument);
}

}  // namespace
}  // namespace nadir::vision
