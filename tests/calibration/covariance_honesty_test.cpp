// Is the covariance that a calibration publishes of itself that of its errors? The truth is the
// synthetic camera, which knows nothing of calibrations.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <random>
#include <string>

#include "calibration/fit/fit.h"
#include "vision/synthetic/camera_model.h"

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;
using vision::CameraModel;
using vision::PixelPoint;

constexpr double kPlane_m = 0.15;
constexpr double kChiSquare95 = 5.991464547107979;

enum Region { kWhole, kMiddle, kCorners, kRegions };

struct Case {
  std::string name;
  double tilt_deg = 0.0;
  double k1 = 0.0;
  int scattered = 0;  ///< number of random points with 0.1 px of noise; 0: an exact grid of 12x9
  double low = 0.9;   ///< limits of the mean over the whole image
  double high = 1.1;
};

void PrintTo(const Case& one, std::ostream* stream) { *stream << one.name; }

/// error^2 / variance of x and of y, summed over places of a region.
struct Ratio {
  Vector2d sum = Vector2d::Zero();
  int places = 0;
  int covered = 0;

  void add(const Vector2d& error_m, const Vector2d& variance_m2) {
    const Vector2d ratio = error_m.cwiseAbs2().cwiseQuotient(variance_m2);
    sum += ratio;
    ++places;
    if (ratio.sum() <= kChiSquare95) ++covered;
  }
  Vector2d mean() const { return sum / places; }
};

struct Honesty {
  std::array<Ratio, kRegions> local;     ///< as published
  std::array<Ratio, kRegions> constant;  ///< with one lack of fit for the whole field
};

CameraModel camera(const Case& one, std::mt19937_64& random) {
  vision::CameraParameters parameters;
  parameters.tilt_rad = one.tilt_deg * M_PI / 180.0;
  parameters.tilt_direction_rad = std::uniform_real_distribution<double>(0.0, 2.0 * M_PI)(random);
  parameters.k1 = one.k1;
  return CameraModel(parameters);
}

PixelPoint random_pixel(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double u = share(random);
  return {1279.0 * u, 1023.0 * share(random)};
}

FieldPoints surveyed(const Case& one, const CameraModel& camera, std::mt19937_64& random) {
  FieldPoints points;
  const auto add = [&](const PixelPoint& pixel, double noise_px) {
    std::normal_distribution<double> normal(0.0, 1.0);
    const PixelPoint found = pixel + noise_px * PixelPoint(normal(random), normal(random));
    points.points.push_back({found, camera.on_plane(pixel, kPlane_m), 0});
  };
  for (int i = 0; i < one.scattered; ++i) add(random_pixel(random), 0.1);
  if (one.scattered > 0) return points;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 12; ++column) {
      add({1279.0 * column / 11.0, 1023.0 * row / 8.0}, 0.0);
    }
  }
  return points;
}

Region region(const PixelPoint& pixel) {
  const double u = std::abs(pixel.x() / 639.5 - 1.0);
  const double v = std::abs(pixel.y() / 511.5 - 1.0);
  if (u < 0.5 && v < 0.5) return kMiddle;
  return u > 0.6 && v > 0.6 ? kCorners : kWhole;
}

/// Variance per axis with the residual variance s^2 = sum r^2 / (2 n - 12) in the sampling error,
/// and what the stated noise leaves of it as lack of fit everywhere.
double constant_variance_m2(const FieldFit& fit, double leverage, double noise_m2) {
  double sum_m2 = 0.0;
  for (const PointResidual& residual : fit.point_residuals)
    sum_m2 += residual.error_m.squaredNorm();
  const double residual_m2 =
      sum_m2 / (2.0 * static_cast<double>(fit.point_residuals.size()) - 12.0);
  return residual_m2 * leverage + std::max(0.0, residual_m2 - noise_m2);
}

void judge(const FieldFit& fit, const CameraModel& camera, double noise_px, int places,
           std::mt19937_64& random, Honesty* honesty) {
  const auto& map = std::get<PolynomialMap>(fit.map.model());
  const double middle_noise_m2 =
      0.5 * noise_px * noise_px * fit.map.jacobian_m_per_px({639.5, 511.5}).squaredNorm();
  for (int i = 0; i < places; ++i) {
    const PixelPoint pixel = random_pixel(random);
    const Vector2d error_m = camera.on_plane(pixel, kPlane_m) - fit.map.plane_from_pixel(pixel);
    const Vector2d variance_m2 = fit.map.calibration_covariance_m2(pixel).diagonal();
    ASSERT_GE(variance_m2.minCoeff(), map.sampling_variance_m2(pixel));
    ASSERT_GT(variance_m2.minCoeff(), 0.0);
    const double leverage = map.sampling_variance_m2(pixel) / map.parameters().noise_variance_m2;
    const Vector2d constant_m2 =
        Vector2d::Constant(constant_variance_m2(fit, leverage, middle_noise_m2));
    for (const Region where : {kWhole, region(pixel)}) {
      honesty->local[where].add(error_m, variance_m2);
      honesty->constant[where].add(error_m, constant_m2);
      if (region(pixel) == kWhole) break;
    }
  }
}

Honesty measured(const Case& one) {
  std::mt19937_64 random(7);
  Honesty honesty;
  const int runs = one.scattered > 0 ? 60 : 4;
  const double noise_px = one.scattered > 0 ? 0.1 : 0.0;
  for (int run = 0; run < runs; ++run) {
    const CameraModel truth = camera(one, random);
    StatedNoise noise;
    if (one.scattered > 0) noise.pixel_px = noise_px;
    const FieldFit fit = fit_polynomial2(surveyed(one, truth, random), noise);
    judge(fit, truth, noise_px, one.scattered > 0 ? 500 : 5000, random, &honesty);
  }
  return honesty;
}

void print(const Case& one, const char* what, const std::array<Ratio, kRegions>& ratios) {
  std::printf("%-24s %-9s", one.name.c_str(), what);
  constexpr std::array<const char*, kRegions> kNames = {"whole", "middle", "corners"};
  for (int where = 0; where < kRegions; ++where) {
    const Ratio& ratio = ratios[where];
    std::printf("  %s %.2f %.2f (%.1f %%)", kNames[where], ratio.mean().x(), ratio.mean().y(),
                100.0 * ratio.covered / ratio.places);
  }
  std::printf("\n");
}

class CovarianceHonesty : public testing::TestWithParam<Case> {};

/// Mean of error^2 / variance over random places: 1 is honest, above is too bold.
TEST_P(CovarianceHonesty, MeanSquaredNormalisedErrorIsOne) {
  const Case& one = GetParam();
  const Honesty honesty = measured(one);
  print(one, "constant", honesty.constant);
  print(one, "local", honesty.local);
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_GT(honesty.local[kWhole].mean()[axis], one.low);
    EXPECT_LT(honesty.local[kWhole].mean()[axis], one.high);
    if (one.k1 == 0.0) continue;
    // A constant is up to 4 in the corners where points were scattered, 0.37 in the middle.
    EXPECT_GT(honesty.local[kMiddle].mean()[axis], 0.9 * one.low);
    EXPECT_LT(honesty.local[kMiddle].mean()[axis], 1.1 * one.high);
    EXPECT_GT(honesty.local[kCorners].mean()[axis], 0.85 * one.low);
    EXPECT_LT(honesty.local[kCorners].mean()[axis], 1.4 * one.high);
  }
}

// Where the noise hides the misfit, or there is none, nobody can tell the two apart: the prior on
// its size then errs by some 30 % to either side.
INSTANTIATE_TEST_SUITE_P(
    Cameras, CovarianceHonesty,
    testing::Values(Case{"grid_tilt1_k0002", 1.0, -0.002}, Case{"grid_tilt3_k0002", 3.0, -0.002},
                    Case{"grid_tilt1_k002", 1.0, -0.02}, Case{"grid_tilt3_k002", 3.0, -0.02},
                    Case{"grid_tilt1_k02", 1.0, -0.2}, Case{"grid_tilt3_k02", 3.0, -0.2},
                    Case{"scattered40_tilt1_k0002", 1.0, -0.002, 40, 0.8, 1.35},
                    Case{"scattered100_tilt1_k0002", 1.0, -0.002, 100, 0.85, 1.15},
                    Case{"scattered40_tilt2_k002", 2.0, -0.02, 40, 0.9, 1.15},
                    Case{"scattered100_tilt2_k002", 2.0, -0.02, 100},
                    Case{"scattered40_tilt3_k02", 3.0, -0.2, 40, 0.9, 1.2},
                    Case{"scattered100_tilt3_k02", 3.0, -0.2, 100},
                    Case{"scattered40_no_misfit", 0.0, 0.0, 40, 0.5, 1.1},
                    Case{"scattered100_no_misfit", 0.0, 0.0, 100, 0.5, 1.1}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace nadir::calibration
