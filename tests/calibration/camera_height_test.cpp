// One calibration serves markers at another height: parallax about the point below the camera.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "calibration/calibration_height.h"
#include "calibration/field_calibration.h"
#include "calibration/survey_file.h"
#include "tests/calibration/camera_points.h"
#include "tests/calibration/synthetic_points.h"
#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;

constexpr double kPlane_m = 0.1;
constexpr double kMarkers_m = 0.25;
constexpr double kNoise_px = 0.1;

FieldPoints noisy(const FieldPoints& points, unsigned seed) {
  std::mt19937_64 random(seed);
  return with_noise(points, kNoise_px, 0.0, random);
}

FieldSettings settings(ModelKind model) {
  FieldSettings result;
  result.model = model;
  result.height_m = kPlane_m;
  result.noise.pixel_px = kNoise_px;
  result.image_width_px = 960;
  result.image_height_px = 720;
  return result;
}

/// Mean of error^T covariance^-1 error / 2 over the field at the markers' height.
double normalised_error(const PlaneMap& map, const vision::CameraModel& camera) {
  double sum = 0.0;
  const FieldPoints places = survey(camera, 21, 16, kMarkers_m);
  for (const FieldPoint& place : places.points) {
    const Vector2d error_m = place.position_m - map.plane_from_pixel(place.pixel);
    sum += error_m.dot(map.calibration_covariance_m2(place.pixel).ldlt().solve(error_m)) / 2.0;
  }
  return sum / static_cast<double>(places.points.size());
}

TEST(PlaneShift, IsExactForAKnownCamera) {
  const vision::CameraModel camera = experiment_camera(-0.1);
  Calibration calibration{
      .map = fit_map(ModelKind::kRadial, survey(camera, 11, 9, kPlane_m), experiment_options())};
  calibration.height_m = kPlane_m;
  calibration.camera = CameraPlace{{0.0, 0.0}, 3.0, Eigen::Matrix2d::Zero(), 0.0};
  EXPECT_GT(true_rms_m(calibration.map, camera, kMarkers_m), 0.05);
  const PlaneMap map = map_at_height(calibration, kMarkers_m);
  EXPECT_LT(true_rms_m(map, camera, kMarkers_m), 1e-9);
  EXPECT_TRUE(is_corrected_at_height(calibration, kMarkers_m));
  const Vector2d place_m(1.2, -0.7);
  const auto pixel = map.pixel_from_plane(place_m);
  ASSERT_TRUE(pixel.has_value());
  EXPECT_LT((map.plane_from_pixel(*pixel) - place_m).norm(), 1e-9);
  EXPECT_LT((*pixel - camera.project({place_m.x(), place_m.y(), kMarkers_m})).norm(), 1e-6);
}

TEST(PlaneShift, JacobianIsTheNumericDerivative) {
  const vision::CameraModel camera = experiment_camera(-0.1);
  const PlaneMap map = fit_map(ModelKind::kRadial, survey(camera), experiment_options())
                           .shifted({{0.2, -0.3}, 0.93, Eigen::Matrix2d::Zero(), 0.0});
  const vision::PixelPoint pixel(200.0, 250.0);
  for (int axis = 0; axis < 2; ++axis) {
    const Vector2d step = 1e-2 * Vector2d::Unit(axis);
    const Vector2d numeric =
        (map.plane_from_pixel(pixel + step) - map.plane_from_pixel(pixel - step)) / 2e-2;
    EXPECT_LT((map.jacobian_m_per_px(pixel).col(axis) - numeric).norm(), 1e-7 * numeric.norm());
  }
}

/// From a focal length (also for a polynomial), from points at two heights, from a tape measure.
TEST(CameraPlace, IsFoundAndCorrectsTheMarkersPlane) {
  const vision::CameraModel camera = experiment_camera(-0.1);
  const FieldPoints points = noisy(survey(camera, 11, 9, kPlane_m), 1);
  const auto check = [&](const FieldSettings& how, double height_tolerance_m, double rms_m) {
    const FieldResult result = calibrate_field(points, how);
    ASSERT_TRUE(result.calibration.camera.has_value());
    const CameraPlace& place = *result.calibration.camera;
    EXPECT_NEAR(place.height_m, 3.0, height_tolerance_m);
    EXPECT_LT(place.nadir_m.norm(), height_tolerance_m);
    // Within what it says of itself.
    EXPECT_LT(std::abs(place.height_m - 3.0), 4.0 * std::sqrt(place.height_variance_m2) + 1e-9);
    EXPECT_LT(place.nadir_m.dot(place.nadir_covariance_m2.ldlt().solve(place.nadir_m)), 16.0);
    const PlaneMap map = map_at_height(result.calibration, kMarkers_m);
    EXPECT_LT(true_rms_m(map, camera, kMarkers_m), rms_m);
    EXPECT_LT(normalised_error(map, camera), 3.0);
  };
  for (const ModelKind model : {ModelKind::kRadial, ModelKind::kRadial2}) {
    FieldSettings focal = settings(model);
    focal.camera.focal_px = 960.0;
    check(focal, 0.02, 1e-3);
  }
  FieldSettings polynomial = settings(ModelKind::kPolynomial5);
  polynomial.camera.focal_px = 960.0;
  check(polynomial, 0.02, 2e-3);
  FieldSettings given = settings(ModelKind::kRadial);
  given.camera.height_m = 3.01;
  given.camera.nadir_m = Vector2d(0.01, -0.01);
  check(given, 0.02, 1.5e-3);
  FieldSettings heights = settings(ModelKind::kRadial);
  for (const FieldPoint& point : noisy(survey(camera, 3, 3, 0.5), 2).points) {
    heights.camera.other_heights.push_back({point, 0.5});
  }
  check(heights, 0.02, 1e-3);
}

TEST(CameraPlace, RefusesHeightsThatSayNothing) {
  const vision::CameraModel camera = experiment_camera(-0.1);
  const PlaneMap map = fit_map(ModelKind::kRadial, survey(camera), experiment_options());
  std::vector<PointAtHeight> one = {{survey(camera, 3, 3, 0.5).points[0], 0.5}};
  EXPECT_NE(vision::input_error_line([&] {
              camera_from_heights(map, 0.0, one, {});
            }).find("do not say where the camera is"),
            std::string::npos);
  std::vector<PointAtHeight> below;
  for (const FieldPoint& point : survey(camera, 3, 3, 0.5).points) below.push_back({point, -0.5});
  EXPECT_NE(vision::input_error_line([&] {
              camera_from_heights(map, 0.0, below, {});
            }).find("do not say where the camera is"),
            std::string::npos);
}

/// Where nothing is known of the camera, the covariance takes the error in.
TEST(MapAtHeight, InflatesTheCovarianceWhereTheCameraIsUnknown) {
  const vision::CameraModel camera = experiment_camera(-0.1);
  const FieldResult result =
      calibrate_field(noisy(survey(camera, 11, 9, kPlane_m), 3), settings(ModelKind::kRadial));
  EXPECT_FALSE(is_corrected_at_height(result.calibration, kMarkers_m));
  EXPECT_TRUE(is_corrected_at_height(result.calibration, kPlane_m));
  const PlaneMap map = map_at_height(result.calibration, kMarkers_m);
  EXPECT_GT(true_rms_m(map, camera, kMarkers_m), 0.05);  // it cannot be put right
  const double normalised = normalised_error(map, camera);
  EXPECT_LT(normalised, 1.2);
  EXPECT_GT(normalised, 0.2);
  const vision::PixelPoint corner(100.0, 100.0);
  EXPECT_EQ(map.plane_from_pixel(corner), result.calibration.map.plane_from_pixel(corner));
}

TEST(CameraPlace, StaysInTheFile) {
  const vision::CameraModel camera = experiment_camera(-0.1);
  FieldSettings focal = settings(ModelKind::kRadial2);
  focal.camera.focal_px = 960.0;
  const FieldResult result = calibrate_field(noisy(survey(camera, 11, 9, kPlane_m), 4), focal);
  const vision::ScratchFolder folder;
  const std::string text = calibration_yaml(result.calibration);
  const Calibration read = load_calibration(folder.write("cal.yaml", text));
  EXPECT_EQ(calibration_yaml(read), text);
  ASSERT_TRUE(read.camera.has_value());
  EXPECT_EQ(read.camera->height_m, result.calibration.camera->height_m);
  const vision::PixelPoint pixel(123.0, 456.0);
  EXPECT_EQ(read.map.plane_from_pixel(pixel), result.calibration.map.plane_from_pixel(pixel));
  EXPECT_EQ(read.map.calibration_covariance_m2(pixel),
            result.calibration.map.calibration_covariance_m2(pixel));
}

TEST(SurveyFile, TellsPointsAtOtherHeightsApart) {
  const vision::ScratchFolder folder;
  const auto file =
      folder.write("points.csv", "u_px,v_px,x_m,y_m,z_m\n1,2,3,4,0.1\n5,6,7,8,0.5\n9,8,7,6,0.1\n");
  const Survey survey = load_survey(file, 0.1);
  ASSERT_EQ(survey.plane.points.size(), 2U);
  ASSERT_EQ(survey.others.size(), 1U);
  EXPECT_EQ(survey.others[0].point.line, 3);
  EXPECT_EQ(survey.others[0].height_m, 0.5);
  EXPECT_NE(vision::input_error_line([&] { load_survey(file, 0.3); }).find("the plane's height"),
            std::string::npos);
  const auto plain = folder.write("plain.csv", "u_px,v_px,x_m,y_m\n1,2,3,4\n");
  EXPECT_EQ(load_survey(plain, 0.3).plane.points.size(), 1U);
}

}  // namespace
}  // namespace nadir::calibration
