#include "calibration/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <vector>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

constexpr const char* kVersionKey = "nadir_calibration";
/// In the order of CameraPlace::Source.
constexpr std::array<const char*, 3> kCameraSources = {"given", "focal", "two_heights"};

template <typename Numbers>
std::string list(const Numbers& numbers) {
  const Eigen::MatrixXd values = numbers;
  return fmt::format("[{}]", fmt::join(values.data(), values.data() + values.size(), ", "));
}

std::string hull_yaml(const char* key, const ConvexHull& hull, int axis) {
  std::vector<double> numbers;
  for (const vision::PixelPoint& vertex : hull.vertices()) numbers.push_back(vertex[axis]);
  return fmt::format("  {}: [{}]\n", key, fmt::join(numbers, ", "));
}

std::string points_yaml(const Calibration& calibration) {
  const PixelBox& box = calibration.points_box;
  const ResidualStatistics& residuals = calibration.residuals;
  std::string text = fmt::format("points:\n  count: {}\n  lowest_px: {}\n  highest_px: {}\n",
                                 residuals.points, list(box.low_px), list(box.high_px));
  const ConvexHull& hull = calibration.map.support().hull;
  text += hull_yaml("hull_u_px", hull, 0) + hull_yaml("hull_v_px", hull, 1);
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
             "of pixels\n"
             "  lack_of_fit:\n    lowest_px: {}\n    highest_px: {}\n    columns: {}\n    rows: "
             "{}\n",
             list(lack.box().low_px), list(lack.box().high_px), lack.columns(), lack.rows()) +
         grid_yaml("error_x_m", lack, [](const auto& node) { return node.error_m.x(); }) +
         grid_yaml("error_y_m", lack, [](const auto& node) { return node.error_m.y(); }) +
         grid_yaml("variance_x_m2", lack, [](const auto& node) { return node.variance_m2.x(); }) +
         grid_yaml("variance_y_m2", lack, [](const auto& node) { return node.variance_m2.y(); });
}

template <typename Parameters>
std::string covariance_yaml(const Parameters& p) {
  std::string text =
      fmt::format("  noise_variance_m2: {}\n  information_inverse:\n", p.noise_variance_m2);
  for (Eigen::Index row = 0; row < p.information_inverse.rows(); ++row) {
    text += fmt::format("    - {{row: {}}}\n", list(p.information_inverse.row(row)));
  }
  return text;
}

std::string model_yaml(const PolynomialMap& map) {
  const PolynomialMap::Parameters& p = map.parameters();
  return fmt::format(
             "# n = (pixel - centre_px) / scale_px; terms 1, u, v, u^2, u v, v^2, ... of n\n"
             "polynomial:\n  centre_px: {}\n  scale_px: {}\n  x_m: {}\n  y_m: {}\n",
             list(p.centre_px), p.scale_px, list(p.coefficients_m.row(0)),
             list(p.coefficients_m.row(1))) +
         covariance_yaml(p);
}

std::string model_yaml(const RadialMap& map) {
  const RadialMap::Parameters& p = map.parameters();
  return fmt::format(
             "# (pixel - centre_px) / scale_px = q (1 + k1 |q|^2 + k2 |q|^4); place = homography "
             "of "
             "q\n"
             "pinhole:\n  centre_px: {}\n  scale_px: {}\n  k1: {}\n  k2: {}\n  homography_m:\n",
             list(p.centre_px), p.scale_px, p.k1, p.k2) +
         fmt::format("    - {{row: {}}}\n    - {{row: {}}}\n    - {{row: {}}}\n",
                     list(p.homography_m.row(0)), list(p.homography_m.row(1)),
                     list(p.homography_m.row(2))) +
         covariance_yaml(p);
}

std::string camera_yaml(const CameraPlace& camera) {
  const Eigen::Matrix2d& covariance_m2 = camera.nadir_covariance_m2;
  return fmt::format(
      "# the projection centre, for markers at another height; covariance: xx, xy, yy\n"
      "camera:\n  known_from: {}\n  nadir_m: {}\n  height_m: {}\n  nadir_covariance_m2: [{}, {}, "
      "{}]\n  height_variance_m2: {}\n",
      kCameraSources.at(static_cast<std::size_t>(camera.source)), list(camera.nadir_m),
      camera.height_m, covariance_m2(0, 0), covariance_m2(0, 1), covariance_m2(1, 1),
      camera.height_variance_m2);
}

}  // namespace

std::string calibration_yaml(const Calibration& calibration) {
  const PlaneMap& map = calibration.map;
  std::string text = fmt::format("{}: {}\nmodel: {}\nheight_m: {}\n", kVersionKey,
                                 kCalibrationVersion, model_name(map.kind()), calibration.height_m);
  if (calibration.image_width_px > 0) {
    text += fmt::format("image_width_px: {}\nimage_height_px: {}\n", calibration.image_width_px,
                        calibration.image_height_px);
  }
  text += points_yaml(calibration);
  if (calibration.camera) text += camera_yaml(*calibration.camera);
  text += std::visit([](const auto& model) { return model_yaml(model); }, map.model());
  return text + lack_of_fit_yaml(map.support().lack_of_fit);
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
