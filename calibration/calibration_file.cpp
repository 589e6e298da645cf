#include "calibration/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <utility>
#include <vector>

#include "vision/input/strict_yaml.h"

namespace nadir::calibration {
namespace {

using vision::YamlMap;

constexpr const char* kVersionKey = "nadir_calibration";
constexpr int kOrder = 2;
constexpr int kTerms = polynomial_terms(kOrder);
constexpr double kMaxHeight_m = 100.0;
constexpr int kMaxImageSide_px = 100000;
constexpr int kMaxGridSide = 1000;

template <typename Numbers>
std::string list(const Numbers& numbers) {
  const Eigen::MatrixXd values = numbers;
  return fmt::format("[{}]", fmt::join(values.data(), values.data() + values.size(), ", "));
}

std::string points_yaml(const Calibration& calibration) {
  const PixelBox& box = calibration.points_box;
  const ResidualStatistics& residuals = calibration.residuals;
  std::string text = fmt::format("points:\n  count: {}\n  lowest_px: {}\n  highest_px: {}\n",
                                 residuals.points, list(box.low_px), list(box.high_px));
  if (calibration.noise.pixel_px) {
    text += fmt::format("  pixel_noise_px: {}\n", *calibration.noise.pixel_px);
  }
  if (calibration.noise.survey_m) {
    text += fmt::format("  survey_noise_m: {}\n", *calibration.noise.survey_m);
  }
  return text +
         fmt::format(
             "residuals:\n  rms_m: {}\n  p95_m: {}\n  max_m: {}\n  rms_px: {}\n  p95_px: {}\n  "
             "max_px: {}\n",
             residuals.rms_m, residuals.p95_m, residuals.max_m, residuals.rms_px, residuals.p95_px,
             residuals.max_px);
}

/// One number of each node, a line a row of the grid.
template <typename NumberOf>
std::string grid_yaml(const char* key, const LackOfFit& lack, NumberOf number_of) {
  std::string text = fmt::format("    {}: [", key);
  for (std::size_t i = 0; i < lack.nodes().size(); ++i) {
    const bool is_row_start = i % static_cast<std::size_t>(lack.columns()) == 0;
    text += is_row_start ? "\n      " : " ";
    text += fmt::format("{},", number_of(lack.nodes()[i]));
  }
  text.back() = ']';
  return text + "\n";
}

std::string lack_of_fit_yaml(const LackOfFit& lack) {
  return fmt::format(
             "  # expected error of the map (true minus mapped) and variance about it, on a grid "
             "of "
             "pixels\n"
             "  lack_of_fit:\n    lowest_px: {}\n    highest_px: {}\n    columns: {}\n    rows: "
             "{}\n",
             list(lack.box().low_px), list(lack.box().high_px), lack.columns(), lack.rows()) +
         grid_yaml("error_x_m", lack, [](const auto& node) { return node.error_m.x(); }) +
         grid_yaml("error_y_m", lack, [](const auto& node) { return node.error_m.y(); }) +
         grid_yaml("variance_x_m2", lack, [](const auto& node) { return node.variance_m2.x(); }) +
         grid_yaml("variance_y_m2", lack, [](const auto& node) { return node.variance_m2.y(); });
}

std::string model_yaml(const PolynomialMap& map) {
  const PolynomialMap::Parameters& p = map.parameters();
  std::string text = fmt::format(
      "# n = (pixel - centre_px) / scale_px; terms 1, u, v, u^2, u v, v^2 of n\n"
      "polynomial:\n  centre_px: {}\n  scale_px: {}\n  x_m: {}\n  y_m: {}\n  noise_variance_m2: "
      "{}\n"
      "  information_inverse:\n",
      list(p.centre_px), p.scale_px, list(p.coefficients_m.row(0)), list(p.coefficients_m.row(1)),
      p.noise_variance_m2);
  for (Eigen::Index row = 0; row < p.information_inverse.rows(); ++row) {
    text += fmt::format("    - {{row: {}}}\n", list(p.information_inverse.row(row)));
  }
  return text + lack_of_fit_yaml(p.lack_of_fit);
}

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

/// Fills what stands under `points`; returns their number.
int read_points(const YamlMap& map, Calibration* calibration) {
  const int count = map.integer("count", {kTerms});
  calibration->points_box = {pair(map, "lowest_px"), pair(map, "highest_px")};
  if ((calibration->points_box.high_px.array() < calibration->points_box.low_px.array()).any()) {
    throw map.error("highest_px", "'highest_px' is below 'lowest_px'", "run nadir-calibrate again");
  }
  if (map.has("pixel_noise_px")) calibration->noise.pixel_px = map.number("pixel_noise_px", {0.0});
  if (map.has("survey_noise_m")) calibration->noise.survey_m = map.number("survey_noise_m", {0.0});
  map.finish();
  return count;
}

PolynomialInformation read_information(const YamlMap& map) {
  const char* const key = "information_inverse";
  const std::vector<YamlMap> rows = map.maps(key);
  PolynomialInformation information(kTerms, kTerms);
  if (rows.size() != kTerms) {
    throw map.error(key, fmt::format("'{}' has {} rows", key, rows.size()), "6 are needed");
  }
  for (int row = 0; row < kTerms; ++row) {
    const std::vector<double> numbers = rows[row].numbers("row", kTerms);
    for (int column = 0; column < kTerms; ++column) information(row, column) = numbers[column];
    rows[row].finish();
  }
  const bool is_symmetric = information.isApprox(information.transpose(), 1e-9);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information, Eigen::EigenvaluesOnly);
  if (!is_symmetric || solver.eigenvalues().minCoeff() <= 0.0) {
    throw map.error(key, fmt::format("'{}' is no covariance", key), "run nadir-calibrate again");
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
    throw map.error("highest_px", "'highest_px' is not above 'lowest_px'",
                    "run nadir-calibrate again");
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

PlaneMap read_polynomial(const YamlMap& map) {
  PolynomialMap::Parameters parameters;
  parameters.order = kOrder;
  parameters.centre_px = pair(map, "centre_px");
  parameters.scale_px = map.number("scale_px", {1e-9});
  parameters.coefficients_m.resize(2, kTerms);
  const std::vector<double> x_m = map.numbers("x_m", kTerms);
  const std::vector<double> y_m = map.numbers("y_m", kTerms);
  for (int term = 0; term < kTerms; ++term)
    parameters.coefficients_m.col(term) << x_m[term], y_m[term];
  parameters.noise_variance_m2 = map.number("noise_variance_m2", {0.0});
  parameters.information_inverse = read_information(map);
  parameters.lack_of_fit = read_lack_of_fit(map.map("lack_of_fit"));
  map.finish();
  return PlaneMap{PolynomialMap(parameters)};
}

void check_version(const YamlMap& file) {
  const int version = file.integer(kVersionKey);
  if (version == kCalibrationVersion) return;
  throw file.error(kVersionKey,
                   fmt::format("calibration of version {}; this nadir reads version {}", version,
                               kCalibrationVersion),
                   "run nadir-calibrate again");
}

}  // namespace

std::string calibration_yaml(const Calibration& calibration) {
  std::string text = fmt::format("{}: {}\nmodel: polynomial2\nheight_m: {}\n", kVersionKey,
                                 kCalibrationVersion, calibration.height_m);
  if (calibration.image_width_px > 0) {
    text += fmt::format("image_width_px: {}\nimage_height_px: {}\n", calibration.image_width_px,
                        calibration.image_height_px);
  }
  text += points_yaml(calibration);
  return text +
         std::visit([](const auto& map) { return model_yaml(map); }, calibration.map.model());
}

Calibration load_calibration(const std::filesystem::path& path) {
  const YamlMap file = YamlMap::load(path);
  check_version(file);
  file.choice("model", {"polynomial2"});
  Calibration calibration{.map = read_polynomial(file.map("polynomial"))};
  calibration.height_m = file.number("height_m", {0.0, kMaxHeight_m});
  if (file.has("image_width_px") || file.has("image_height_px")) {
    calibration.image_width_px = file.integer("image_width_px", {1, kMaxImageSide_px});
    calibration.image_height_px = file.integer("image_height_px", {1, kMaxImageSide_px});
  }
  const int points = read_points(file.map("points"), &calibration);
  calibration.residuals = read_residuals(file.map("residuals"), points);
  file.finish();
  return calibration;
}

void check_image_size(const Calibration& calibration, const std::filesystem::path& file,
                      int width_px, int height_px) {
  const vision::InputPlace place{file.string()};
  const std::string frame = fmt::format("the image is {}x{}", width_px, height_px);
  if (calibration.image_width_px > 0 &&
      (calibration.image_width_px != width_px || calibration.image_height_px != height_px)) {
    throw vision::InputError(
        place,
        fmt::format("made for images of {}x{}, but {}", calibration.image_width_px,
                    calibration.image_height_px, frame),
        "calibrate with images of this size");
  }
  // The outer borders of the corner pixels: the centre of the first is (0, 0).
  const PixelBox& box = calibration.points_box;
  if (box.low_px.minCoeff() < -0.5 || box.high_px.x() > width_px - 0.5 ||
      box.high_px.y() > height_px - 0.5) {
    throw vision::InputError(
        place,
        fmt::format("its points reach from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f}) px, but {}",
                    box.low_px.x(), box.low_px.y(), box.high_px.x(), box.high_px.y(), frame),
        "calibrate with images of this size");
  }
}

}  // namespace nadir::calibration
