// Reads calibration files, strictly.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "calibration/calibration_file.h"
#include "vision/input/strict_yaml.h"

namespace nadir::calibration {
namespace {

using vision::YamlMap;

constexpr const char* kVersionKey = "nadir_calibration";
constexpr const char* kAgain = "run nadir-calibrate again";
constexpr double kMaxHeight_m = 100.0;
constexpr double kMaxCameraHeight_m = 1000.0;
constexpr int kMaxImageSide_px = 100000;
constexpr int kMaxGridSide = 1000;

Eigen::Vector2d pair(const YamlMap& map, const std::string& key) {
  const std::vector<double> numbers = map.numbers(key, 2);
  return {numbers[0], numbers[1]};
}

ResidualStatistics read_residuals(const YamlMap& map, int points) {
  const vision::ValidRange distance{0.0};
  ResidualStatistics residuals{points,
                               map.number("rms_m", distance),
                               map.number("p95_m", distance),
                               map.number("max_m", distance),
                               map.number("rms_px", distance),
                               map.number("p95_px", distance),
                               map.number("max_px", distance)};
  map.finish();
  return residuals;
}

/// The polygon around the points; in version 1 their box.
ConvexHull read_hull(const YamlMap& map, int version, const PixelBox& box) {
  if (version == 1) {
    return ConvexHull::of({box.low_px,
                           {box.high_px.x(), box.low_px.y()},
                           box.high_px,
                           {box.low_px.x(), box.high_px.y()}});
  }
  const std::vector<double> u_px = map.numbers("hull_u_px");
  const std::vector<double> v_px = map.numbers("hull_v_px", u_px.size());
  std::vector<vision::PixelPoint> vertices;
  for (std::size_t i = 0; i < u_px.size(); ++i) vertices.emplace_back(u_px[i], v_px[i]);
  try {
    return ConvexHull(std::move(vertices));
  } catch (const std::invalid_argument&) {
    throw map.error("hull_u_px", "'hull_u_px' and 'hull_v_px' are no convex polygon", kAgain);
  }
}

/// What stands under `points`.
struct Points {
  int count = 0;
  PixelBox box{};
  ConvexHull hull{};
  StatedNoise noise{};
};

Points read_points(const YamlMap& map, int version, ModelKind model) {
  Points points;
  points.count = map.integer("count", {static_cast<double>(least_points(model))});
  points.box = {pair(map, "lowest_px"), pair(map, "highest_px")};
  if ((points.box.high_px.array() < points.box.low_px.array()).any()) {
    throw map.error("highest_px", "'highest_px' is below 'lowest_px'", kAgain);
  }
  points.hull = read_hull(map, version, points.box);
  if (map.has("pixel_noise_px")) points.noise.pixel_px = map.number("pixel_noise_px", {0.0});
  if (map.has("survey_noise_m")) points.noise.survey_m = map.number("survey_noise_m", {0.0});
  map.finish();
  return points;
}

/// `count` rows of as many numbers.
Eigen::MatrixXd read_square(const YamlMap& map, const char* key, int count) {
  const std::vector<YamlMap> rows = map.maps(key);
  if (rows.size() != static_cast<std::size_t>(count)) {
    throw map.error(key, fmt::format("'{}' has {} rows", key, rows.size()),
                    fmt::format("{} are needed", count));
  }
  Eigen::MatrixXd square(count, count);
  for (int row = 0; row < count; ++row) {
    const YamlMap& line = rows[static_cast<std::size_t>(row)];
    const std::vector<double> numbers = line.numbers("row", static_cast<std::size_t>(count));
    square.row(row) = Eigen::Map<const Eigen::RowVectorXd>(numbers.data(), count);
    line.finish();
  }
  return square;
}

/// A symmetric matrix without negative eigenvalues, up to rounding.
bool is_covariance(const Eigen::MatrixXd& matrix) {
  // Parameters of different units: correlations are what can be compared.
  const Eigen::VectorXd scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlations = scale.asDiagonal() * matrix * scale.asDiagonal();
  if (!correlations.allFinite() || matrix.diagonal().minCoeff() < 0.0) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlations, Eigen::EigenvaluesOnly);
  return correlations.isApprox(correlations.transpose(), 1e-9) &&
         solver.eigenvalues().minCoeff() > -1e-9;
}

Eigen::MatrixXd read_information(const YamlMap& map, int count) {
  const char* const key = "information_inverse";
  Eigen::MatrixXd information = read_square(map, key, count);
  if (!is_covariance(information)) {
    throw map.error(key, fmt::format("'{}' is no covariance", key), kAgain);
  }
  return information;
}

LackOfFit read_lack_of_fit(const YamlMap& map) {
  const PixelBox box{pair(map, "lowest_px"), pair(map, "highest_px")};
  const int columns = map.integer("columns", {1, kMaxGridSide});
  const int rows = map.integer("rows", {1, kMaxGridSide});
  const bool is_flat = (columns > 1 && box.high_px.x() <= box.low_px.x()) ||
                       (rows > 1 && box.high_px.y() <= box.low_px.y());
  if (is_flat) {
    throw map.error("highest_px", "'highest_px' is not above 'lowest_px'", kAgain);
  }
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const std::vector<double> error_x_m = map.numbers("error_x_m", count);
  const std::vector<double> error_y_m = map.numbers("error_y_m", count);
  const std::vector<double> variance_x_m2 = map.numbers("variance_x_m2", count, {0.0});
  const std::vector<double> variance_y_m2 = map.numbers("variance_y_m2", count, {0.0});
  map.finish();
  std::vector<LackOfFitNode> nodes;
  for (std::size_t i = 0; i < count; ++i) {
    nodes.push_back({{error_x_m[i], error_y_m[i]}, {variance_x_m2[i], variance_y_m2[i]}});
  }
  return {box, columns, rows, std::move(nodes)};
}

PolynomialMap read_polynomial(const YamlMap& map, ModelKind model) {
  const int terms = polynomial_terms(polynomial_order(model));
  PolynomialMap::Parameters parameters;
  parameters.order = polynomial_order(model);
  parameters.centre_px = pair(map, "centre_px");
  parameters.scale_px = map.number("scale_px", {1e-9});
  const std::vector<double> x_m = map.numbers("x_m", static_cast<std::size_t>(terms));
  const std::vector<double> y_m = map.numbers("y_m", static_cast<std::size_t>(terms));
  parameters.coefficients_m.resize(2, terms);
  parameters.coefficients_m.row(0) = Eigen::Map<const Eigen::RowVectorXd>(x_m.data(), terms);
  parameters.coefficients_m.row(1) = Eigen::Map<const Eigen::RowVectorXd>(y_m.data(), terms);
  parameters.noise_variance_m2 = map.number("noise_variance_m2", {0.0});
  parameters.information_inverse = read_information(map, terms);
  return PolynomialMap(parameters);
}

RadialMap read_pinhole(const YamlMap& map, ModelKind model) {
  RadialMap::Parameters parameters;
  parameters.kind = model;
  parameters.centre_px = pair(map, "centre_px");
  parameters.scale_px = map.number("scale_px", {1e-9});
  parameters.homography_m = read_square(map, "homography_m", 3);
  const Eigen::Matrix3d& homography = parameters.homography_m;
  if (homography(2, 2) != 1.0 || homography.determinant() == 0.0) {
    throw map.error("homography_m", "'homography_m' does not end in 1 or is singular", kAgain);
  }
  parameters.k1 = map.number("k1");
  parameters.k2 = map.number("k2");
  parameters.noise_variance_m2 = map.number("noise_variance_m2", {0.0});
  parameters.information_inverse = read_information(map, parameter_count(model));
  return RadialMap(parameters);
}

CameraPlace read_camera(const YamlMap& map) {
  CameraPlace camera;
  const std::string source = map.choice("known_from", {"given", "focal", "two_heights"});
  camera.source = source == "given"   ? CameraPlace::Source::kGiven
                  : source == "focal" ? CameraPlace::Source::kFocal
                                      : CameraPlace::Source::kTwoHeights;
  camera.nadir_m = pair(map, "nadir_m");
  camera.height_m = map.number("height_m", {0.0, kMaxCameraHeight_m});
  const std::vector<double> numbers = map.numbers("nadir_covariance_m2", 3);
  camera.nadir_covariance_m2 << numbers[0], numbers[1], numbers[1], numbers[2];
  if (!is_covariance(camera.nadir_covariance_m2)) {
    throw map.error("nadir_covariance_m2", "'nadir_covariance_m2' is no covariance", kAgain);
  }
  camera.height_variance_m2 = map.number("height_variance_m2", {0.0});
  map.finish();
  return camera;
}

/// 1 or kCalibrationVersion.
int read_version(const YamlMap& file) {
  const int version = file.integer(kVersionKey);
  if (version >= 1 && version <= kCalibrationVersion) return version;
  throw file.error(kVersionKey,
                   fmt::format("calibration of version {}; this nadir reads versions 1 to {}",
                               version, kCalibrationVersion),
                   kAgain);
}

ModelKind read_model(const YamlMap& file, int version) {
  std::vector<std::string> names;
  names.reserve(kAllModels.size());
  for (const ModelKind model : kAllModels) names.emplace_back(model_name(model));
  if (version == 1) names = {"polynomial2"};
  return *model_from_name(file.choice("model", names));
}

/// The model and its support, whose lack of fit stands under the model.
PlaneMap read_map(const YamlMap& file, ModelKind model, ConvexHull hull) {
  const bool is_polynomial = polynomial_order(model) > 0;
  const YamlMap map = file.map(is_polynomial ? "polynomial" : "pinhole");
  PlaneMap::Model read = is_polynomial ? PlaneMap::Model(read_polynomial(map, model))
                                       : PlaneMap::Model(read_pinhole(map, model));
  MapSupport support{read_lack_of_fit(map.map("lack_of_fit")), std::move(hull)};
  map.finish();
  return PlaneMap(std::move(read), std::move(support));
}

}  // namespace

Calibration load_calibration(const std::filesystem::path& path) {
  const YamlMap file = YamlMap::load(path);
  const int version = read_version(file);
  const ModelKind model = read_model(file, version);
  const double height_m = file.number("height_m", {0.0, kMaxHeight_m});
  Points points = read_points(file.map("points"), version, model);
  Calibration calibration{.map = read_map(file, model, std::move(points.hull)),
                          .height_m = height_m,
                          .points_box = points.box,
                          .noise = points.noise};
  if (file.has("image_width_px") || file.has("image_height_px")) {
    calibration.image_width_px = file.integer("image_width_px", {1, kMaxImageSide_px});
    calibration.image_height_px = file.integer("image_height_px", {1, kMaxImageSide_px});
  }
  calibration.residuals = read_residuals(file.map("residuals"), points.count);
  if (version > 1) {
    if (const auto camera = file.map_if_present("camera"))
      calibration.camera = read_camera(*camera);
  }
  file.finish();
  return calibration;
}

}  // namespace nadir::calibration
