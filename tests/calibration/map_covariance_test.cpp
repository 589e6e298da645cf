// The covariance that a fit predicts for its parameters against the scatter of 500 fits.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <string>
#include <vector>

#include "calibration/fit/cross_validation.h"
#include "calibration/fit/fit.h"
#include "tests/calibration/camera_points.h"
#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;
using vision::PixelPoint;

constexpr int kRuns = 500;
const StatedNoise kNoise{.pixel_px = 0.2, .survey_m = 0.0005};

/// Points whose errors are those of noise alone, for each model.
FieldPoints exact_points(ModelKind model) {
  const double k1 = model == ModelKind::kRadial || model == ModelKind::kRadial2 ? -0.2 : 0.0;
  FieldPoints points = survey(experiment_camera(k1), 10, 8);
  if (polynomial_order(model) == 0) return points;
  // What a polynomial says of a gently distorting camera is a truth of its own kind.
  const PlaneMap map = fit_map(model, survey(experiment_camera(-0.02), 10, 8));
  for (FieldPoint& point : points.points) point.position_m = map.plane_from_pixel(point.pixel);
  return points;
}

class MapCovariance : public testing::TestWithParam<ModelKind> {};

TEST_P(MapCovariance, IsThatOf500Fits) {
  const FieldPoints exact = exact_points(GetParam());
  const PlaneMap truth = fit_map(GetParam(), exact, experiment_options());
  std::vector<PixelPoint> places;
  for (std::size_t i = 0; i < exact.points.size(); i += 3) places.push_back(exact.points[i].pixel);
  std::mt19937_64 random(77);
  std::vector<double> scatter_m2(places.size(), 0.0);
  std::vector<double> predicted_m2(places.size(), 0.0);
  double normalised = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const FieldPoints points = with_noise(exact, *kNoise.pixel_px, *kNoise.survey_m, random);
    const PlaneMap map = fit_sampled_map(GetParam(), points, kNoise, experiment_options());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vector2d error_m = map.plane_from_pixel(places[i]) - truth.plane_from_pixel(places[i]);
      const Eigen::Matrix2d covariance_m2 = map.sampling_covariance_m2(places[i]);
      scatter_m2[i] += error_m.squaredNorm();
      predicted_m2[i] += covariance_m2.trace();
      normalised += error_m.dot(covariance_m2.inverse() * error_m) / 2.0;
    }
  }
  // All places count alike: in metres, two corners would outweigh the rest.
  double ratio = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    ratio += scatter_m2[i] / predicted_m2[i] / static_cast<double>(places.size());
  }
  EXPECT_NEAR(ratio, 1.0, 0.05);
  EXPECT_NEAR(normalised / (kRuns * static_cast<double>(places.size())), 1.0, 0.05);
}

/// Points with known noise that the fit has not seen lie in their 95 % ellipses.
TEST_P(MapCovariance, EllipsesHold95PercentOfOtherPoints) {
  constexpr double kChiSquare95 = 5.991464547107979;
  constexpr int kFits = 12;
  const FieldPoints exact = exact_points(GetParam());
  const PlaneMap truth = fit_map(GetParam(), exact, experiment_options());
  std::mt19937_64 random(78);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const PixelBox box = pixel_box(exact);
  int inside = 0;
  int count = 0;
  for (int run = 0; run < kFits; ++run) {
    const FieldPoints points = with_noise(exact, *kNoise.pixel_px, *kNoise.survey_m, random);
    const PlaneMap map = fit_field(GetParam(), points, kNoise, experiment_options()).map;
    for (int i = 0; i < 1000; ++i) {
      const double u = share(random);
      const PixelPoint pixel =
          box.low_px + Vector2d(u, share(random)).cwiseProduct(box.high_px - box.low_px);
      if (map.is_extrapolated(pixel)) continue;
      FieldPoints seen{"", {{pixel, truth.plane_from_pixel(pixel), 0}}};
      seen = with_noise(seen, *kNoise.pixel_px, *kNoise.survey_m, random);
      const FieldPoint& point = seen.points.front();
      const Eigen::Matrix2d covariance_m2 =
          kNoise.covariance_m2(map.jacobian_m_per_px(point.pixel)) +
          map.calibration_covariance_m2(point.pixel);
      const Vector2d error_m = point.position_m - map.plane_from_pixel(point.pixel);
      inside += error_m.dot(covariance_m2.inverse() * error_m) <= kChiSquare95 ? 1 : 0;
      ++count;
    }
  }
  const double coverage = static_cast<double>(inside) / count;
  EXPECT_GT(coverage, 0.93);
  EXPECT_LT(coverage, 0.97);
}

INSTANTIATE_TEST_SUITE_P(All, MapCovariance, testing::ValuesIn(kAllModels),
                         [](const auto& test) { return std::string(model_name(test.param)); });

}  // namespace
}  // namespace nadir::calibration
