#include "calibration/diagnosis/set_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;

/// No field that one camera sees is wider, m; in centimetres it would be at most ten times so.
constexpr double kWidestField_m = 100.0;
constexpr double kSurelyMillimetres_m = 1000.0;
constexpr double kNarrowestField_m = 0.02;
/// Against each other, the scales of x and y of one camera. A wrong unit makes it 100 or 1000.
constexpr double kMostAnisotropy = 20.0;
/// A typical error of so much of the field's width: pixels and metres do not belong together.
constexpr double kMixedUpShare = 0.03;
constexpr int kComfortablePoints = 20;
constexpr int kImageCells = 6;
constexpr double kMostUncoveredShare = 0.25;
constexpr double kNarrowStrip = 0.1;

Vector2d extent_m(const FieldPoints& points) {
  Vector2d low_m = points.points.front().position_m;
  Vector2d high_m = low_m;
  for (const FieldPoint& point : points.points) {
    low_m = low_m.cwiseMin(point.position_m);
    high_m = high_m.cwiseMax(point.position_m);
  }
  return high_m - low_m;
}

Finding failure(const char* kind, std::string text) {
  return {Grade::kFail, kind, {}, std::move(text)};
}

/// Of both columns. A single wrong row does not make a wide field, so the middle half counts.
std::optional<Finding> wrong_unit(const FieldPoints& points) {
  const Vector2d extent = extent_m(points);
  std::vector<double> distances_m;
  Vector2d mean_m = Vector2d::Zero();
  for (const FieldPoint& point : points.points) mean_m += point.position_m;
  mean_m /= static_cast<double>(points.points.size());
  for (const FieldPoint& point : points.points) {
    distances_m.push_back((point.position_m - mean_m).norm());
  }
  const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
  std::nth_element(distances_m.begin(), middle, distances_m.end());
  const double width_m = 2.0 * *middle;
  if (width_m > 0.5 * kWidestField_m) {
    const bool is_sure = width_m > 0.5 * kSurelyMillimetres_m;
    return failure("units", fmt::format("the points span {:.0f} x {:.0f} m: x_m and y_m are in {}. "
                                        "Write metres.",
                                        extent.x(), extent.y(),
                                        is_sure ? "millimetres" : "millimetres or centimetres"));
  }
  if (extent.maxCoeff() < kNarrowestField_m) {
    return failure("units",
                   fmt::format("the points span {:.3g} x {:.3g} m, too little for a field: "
                               "x_m and y_m are not in metres.",
                               extent.x(), extent.y()));
  }
  return std::nullopt;
}

std::optional<Finding> unit_of_one_column(const Eigen::Matrix2d& jacobian) {
  const double ratio = jacobian.row(0).norm() / jacobian.row(1).norm();
  if (ratio < kMostAnisotropy && ratio > 1.0 / kMostAnisotropy) return std::nullopt;
  return failure(
      "units", fmt::format("{} changes {:.0f} times as much with the pixels as {}: one of the two "
                           "is not in metres.",
                           ratio > 1.0 ? "x_m" : "y_m", std::max(ratio, 1.0 / ratio),
                           ratio > 1.0 ? "y_m" : "x_m"));
}

/// Seen from above with v down, y must point to the left of x: the determinant is negative. Which
/// column is wrong cannot be told without knowing how the camera is turned; upright it is the one
/// named.
std::optional<Finding> mirrored(const Eigen::Matrix2d& jacobian) {
  if (!(jacobian.determinant() > 0.0)) return std::nullopt;
  const bool is_turned = std::abs(jacobian(0, 1)) + std::abs(jacobian(1, 0)) >
                         std::abs(jacobian(0, 0)) + std::abs(jacobian(1, 1));
  const char* guess = is_turned              ? "are x_m and y_m swapped?"
                      : jacobian(0, 0) > 0.0 ? "has y_m the wrong sign?"
                                             : "has x_m the wrong sign?";
  return failure("mirrored",
                 fmt::format("the field is mirrored: seen from above, with v down, y must point to "
                             "the left of x; {} (or u_px and v_px swapped, or the image mirrored)",
                             guess));
}

Eigen::Matrix2d middle_jacobian(const FieldPoints& points, const PlaneMap& map) {
  const PixelBox box = pixel_box(points);
  return map.jacobian_m_per_px(0.5 * (box.low_px + box.high_px));
}

std::optional<Finding> few_points(ModelKind model, const FieldPoints& points) {
  const auto count = static_cast<int>(points.points.size());
  const int least = parameter_count(model);
  if (count < least) {
    return failure("few points",
                   fmt::format("{} points are too few for {}, which has {} parameters: their "
                               "residuals say little of the error. Give {} or more, better twice "
                               "as many.",
                               count, model_name(model), least, least));
  }
  if (count >= kComfortablePoints) return std::nullopt;
  return Finding{Grade::kPass,
                 "few points",
                 {},
                 fmt::format("{} points are few; give {} or more, spread to the corners of the "
                             "field.",
                             count, kComfortablePoints)};
}

/// "left", "top right", ...
std::string side_name(const Vector2d& share) {
  const char* vertical = share.y() < 1.0 / 3.0 ? "top" : share.y() > 2.0 / 3.0 ? "bottom" : "";
  const char* horizontal = share.x() < 1.0 / 3.0 ? "left" : share.x() > 2.0 / 3.0 ? "right" : "";
  std::string name = vertical;
  if (*horizontal) name += (name.empty() ? "" : " ") + std::string(horizontal);
  return name.empty() ? "middle" : name;
}

std::optional<Finding> uncovered(const ConvexHull& hull, int width_px, int height_px) {
  std::map<std::string, int> empty;
  int count = 0;
  for (int row = 0; row < kImageCells; ++row) {
    for (int column = 0; column < kImageCells; ++column) {
      const Vector2d share((column + 0.5) / kImageCells, (row + 0.5) / kImageCells);
      if (hull.holds(share.cwiseProduct(Vector2d(width_px, height_px)))) continue;
      ++empty[side_name(share)];
      ++count;
    }
  }
  const double part = static_cast<double>(count) / (kImageCells * kImageCells);
  if (part <= kMostUncoveredShare) return std::nullopt;
  std::vector<std::string> names;
  names.reserve(empty.size());
  for (const auto& [name, cells] : empty) names.push_back(name);
  return Finding{Grade::kWarn,
                 "uncovered",
                 {},
                 fmt::format("{:.0f} % of the image has no points around it ({}): positions there "
                             "are extrapolated.",
                             100.0 * part, fmt::join(names, ", "))};
}

std::optional<Finding> narrow_strip(const FieldPoints& points) {
  Vector2d mean_px = Vector2d::Zero();
  for (const FieldPoint& point : points.points) mean_px += point.pixel;
  mean_px /= static_cast<double>(points.points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const FieldPoint& point : points.points) {
    spread += (point.pixel - mean_px) * (point.pixel - mean_px).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
  const double ratio = std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / solver.eigenvalues()[1]);
  if (!(ratio < kNarrowStrip)) return std::nullopt;
  return Finding{
      Grade::kWarn,
      "narrow strip",
      {},
      fmt::format("the points lie on a strip {:.2g} times as wide as long: across it the "
                  "map is hardly known.",
                  ratio)};
}

std::vector<Finding> repeated_rows(const FieldPoints& points) {
  std::map<std::tuple<double, double>, int> seen;
  std::vector<Finding> findings;
  for (const FieldPoint& point : points.points) {
    const auto [entry, is_new] = seen.try_emplace({point.pixel.x(), point.pixel.y()}, point.line);
    if (is_new) continue;
    findings.push_back({Grade::kPass,
                        "repeated row",
                        {point.line, entry->second},
                        fmt::format("line {} is the same as line {}: it counts twice.", point.line,
                                    entry->second)});
  }
  return findings;
}

}  // namespace

std::vector<Finding> set_findings(const FieldPoints& points,
                                  const std::optional<RobustReference>& reference) {
  std::vector<Finding> findings;
  const auto add = [&findings](std::optional<Finding> finding) {
    if (finding) findings.push_back(std::move(*finding));
  };
  Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
  if (reference) {
    jacobian = middle_jacobian(points, reference->map);
    add(unit_of_one_column(jacobian));
  }
  if (findings.empty()) add(wrong_unit(points));
  if (!reference) return findings;
  if (reference->sigma_m > kMixedUpShare * extent_m(points).maxCoeff()) {
    findings.push_back(
        failure("mixed up",
                fmt::format("the points are {:.3g} mm off any smooth map: pixels and metres do not "
                            "belong together. Were rows mixed up, or left out in one column?",
                            1e3 * reference->sigma_m)));
    return findings;
  }
  add(mirrored(jacobian));
  return findings;
}

std::vector<Finding> coverage_findings(ModelKind model, const FieldPoints& points, int width_px,
                                       int height_px) {
  std::vector<Finding> findings;
  const auto add = [&findings](std::optional<Finding> finding) {
    if (finding) findings.push_back(std::move(*finding));
  };
  add(few_points(model, points));
  if (width_px > 0) add(uncovered(pixel_hull(points), width_px, height_px));
  add(narrow_strip(points));
  for (Finding& finding : repeated_rows(points)) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace nadir::calibration
