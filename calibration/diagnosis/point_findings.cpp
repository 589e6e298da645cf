#include "calibration/diagnosis/point_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;

constexpr double kOutlierSigmas = 7.0;
/// What is this small is an error of finding the point, not of typing it.
constexpr double kLeastOutlier_px = 0.3;
/// Below, an error that nothing explains may also be the lens's: it is a warning.
constexpr double kSurelyTyped_px = 5.0;
/// At the border, this share of the points' box wide, a point has no neighbours on one side:
/// without it the reference extrapolates, and is this many times worse.
constexpr double kBorderShare = 0.03;
constexpr double kBorderFactor = 3.0;
constexpr std::size_t kNeighbours = 8;
/// A point is explained by a change that leaves at most so many sigma, and at most this share of
/// what stood out.
constexpr double kExplainedSigmas = 6.0;
constexpr double kExplainedShare = 0.15;
/// More wrong points than this are not listed one by one.
constexpr std::size_t kMostListed = 10;
constexpr double kMixedUpShare = 0.25;

/// A row that stands out.
struct Outlier {
  std::size_t index = 0;
  Vector2d expected_m = Vector2d::Zero();  ///< where the reference sees the point
  double tolerance_m = 0.0;                ///< within which a changed row is right
  double distance_px = 0.0;                ///< by which it stands out, in the image
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median residual of the nearest other points, per axis: what the reference itself is off there.
Vector2d neighbours_error_m(const FieldPoints& points, const RobustReference& reference,
                            std::size_t index) {
  std::vector<std::size_t> order(points.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase(order, index);
  const std::size_t count = std::min(kNeighbours, order.size());
  const vision::PixelPoint& here = points.points[index].pixel;
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return (points.points[a].pixel - here).squaredNorm() <
                             (points.points[b].pixel - here).squaredNorm();
                    });
  std::vector<double> x_m;
  std::vector<double> y_m;
  for (std::size_t i = 0; i < count; ++i) {
    x_m.push_back(reference.residuals[order[i]].error_m.x());
    y_m.push_back(reference.residuals[order[i]].error_m.y());
  }
  return {median(std::move(x_m)), median(std::move(y_m))};
}

/// Which points have no neighbours on one side.
std::vector<bool> border_points(const FieldPoints& points) {
  const ConvexHull hull = pixel_hull(points);
  const PixelBox box = pixel_box(points);
  const vision::PixelPoint middle = 0.5 * (box.low_px + box.high_px);
  std::vector<bool> is_border;
  for (const FieldPoint& point : points.points) {
    // A little farther out it would be outside.
    const vision::PixelPoint outward = (1.0 + 2.0 * kBorderShare) * (point.pixel - middle) + middle;
    is_border.push_back(!hull.holds(outward));
  }
  return is_border;
}

std::vector<Outlier> outliers(const FieldPoints& points, const RobustReference& reference,
                              const StatedNoise& noise) {
  const std::vector<bool> is_border = border_points(points);
  const double survey_m = noise.survey_m.value_or(0.0);
  const double pixel_px = noise.pixel_px.value_or(0.0);
  std::vector<Outlier> found;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const PointResidual& residual = reference.residuals[i];
    // Metres a pixel towards the error.
    const double scale_m =
        residual.distance_px > 0.0 ? residual.distance_m / residual.distance_px : 0.0;
    const double sigma_m = std::max({reference.sigma_m, survey_m, pixel_px * scale_m});
    double limit_m =
        std::max({kOutlierSigmas * sigma_m, kOutlierSigmas * reference.sigma_px * scale_m,
                  kLeastOutlier_px * scale_m});
    if (is_border[i]) limit_m = std::max(kBorderFactor * limit_m, kSurelyTyped_px * scale_m);
    if (!(residual.distance_m > limit_m)) continue;
    const Vector2d around_m = neighbours_error_m(points, reference, i);
    if ((residual.error_m - around_m).norm() <= limit_m) continue;
    const double tolerance_m =
        std::max(kExplainedSigmas * std::max(sigma_m, reference.sigma_px * scale_m),
                 kExplainedShare * residual.distance_m);
    found.push_back({i, points.points[i].position_m - residual.error_m + around_m, tolerance_m,
                     residual.distance_px});
  }
  return found;
}

bool is_right(const Outlier& outlier, const Vector2d& place_m) {
  return (place_m - outlier.expected_m).norm() <= outlier.tolerance_m;
}

struct Change {
  const char* words;
  std::function<Vector2d(const Vector2d&)> applied;
  bool is_unit = false;  ///< only for places outside of the field of the others
};

/// Slips that one change undoes.
const std::vector<Change>& changes() {
  static const std::vector<Change> known_changes = {
      {"x_m and y_m are swapped", [](const Vector2d& p) { return Vector2d(p.y(), p.x()); }},
      {"x_m has the wrong sign", [](const Vector2d& p) { return Vector2d(-p.x(), p.y()); }},
      {"y_m has the wrong sign", [](const Vector2d& p) { return Vector2d(p.x(), -p.y()); }},
      {"x_m and y_m have the wrong sign", [](const Vector2d& p) { return Vector2d(-p); }},
      {"x_m and y_m are in millimetres", [](const Vector2d& p) { return Vector2d(p / 1e3); }, true},
      {"x_m is in millimetres", [](const Vector2d& p) { return Vector2d(p.x() / 1e3, p.y()); },
       true},
      {"y_m is in millimetres", [](const Vector2d& p) { return Vector2d(p.x(), p.y() / 1e3); },
       true},
      {"x_m and y_m are in centimetres", [](const Vector2d& p) { return Vector2d(p / 1e2); }, true},
      {"x_m is in centimetres", [](const Vector2d& p) { return Vector2d(p.x() / 1e2, p.y()); },
       true},
      {"y_m is in centimetres", [](const Vector2d& p) { return Vector2d(p.x(), p.y() / 1e2); },
       true},
  };
  return known_changes;
}

/// Farther from the origin in x or y than all other points.
bool is_outside_of_others(const FieldPoints& points, std::size_t index) {
  Vector2d farthest_m = Vector2d::Zero();
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (i == index) continue;
    farthest_m = farthest_m.cwiseMax(points.points[i].position_m.cwiseAbs());
  }
  return (points.points[index].position_m.cwiseAbs().array() > farthest_m.array()).any();
}

Finding failure(const char* kind, std::vector<int> lines, std::string text) {
  return {Grade::kFail, kind, std::move(lines), std::move(text)};
}

/// Off in one axis alone, or in both. `guess` ends the sentence.
Finding typing_error(const FieldPoint& point, const Outlier& outlier, const std::string& guess) {
  const Vector2d off_m = point.position_m - outlier.expected_m;
  const double across_m = off_m.cwiseAbs().minCoeff();
  if (across_m > std::max(outlier.tolerance_m / 3.0, 0.25 * off_m.cwiseAbs().maxCoeff())) {
    return failure("typing error", {point.line},
                   fmt::format("line {}: the place is off by {:.0f} mm in x_m and {:.0f} mm in "
                               "y_m; the other points say ({:.3f}, {:.3f}). {}",
                               point.line, 1e3 * off_m.x(), 1e3 * off_m.y(), outlier.expected_m.x(),
                               outlier.expected_m.y(), guess));
  }
  const int axis = std::abs(off_m.x()) > std::abs(off_m.y()) ? 0 : 1;
  return failure("typing error", {point.line},
                 fmt::format("line {}: {} is {:.0f} mm too {}: {} where the other points say "
                             "{:.3f}. {}",
                             point.line, axis == 0 ? "x_m" : "y_m", 1e3 * std::abs(off_m[axis]),
                             off_m[axis] > 0.0 ? "large" : "small", point.position_m[axis],
                             outlier.expected_m[axis], guess));
}

std::optional<Finding> undone_slip(const FieldPoints& points, const Outlier& outlier) {
  const FieldPoint& point = points.points[outlier.index];
  const bool is_outside = is_outside_of_others(points, outlier.index);
  const Change* best = nullptr;
  double least_m = outlier.tolerance_m;
  for (const Change& change : changes()) {
    if (change.is_unit && !is_outside) continue;
    const double left_m = (change.applied(point.position_m) - outlier.expected_m).norm();
    if (left_m > least_m) continue;
    least_m = left_m;
    best = &change;
  }
  if (!best) return std::nullopt;
  return typing_error(point, outlier, fmt::format("Probably {}.", best->words));
}

/// Another row, itself right, has exactly this place.
std::optional<Finding> copied_place(const FieldPoints& points, std::size_t index,
                                    const std::vector<Outlier>& all) {
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (i == index || points.points[i].position_m != points.points[index].position_m) continue;
    const bool is_wrong =
        std::any_of(all.begin(), all.end(), [i](const Outlier& other) { return other.index == i; });
    if (is_wrong) continue;
    return failure("repeated place", {points.points[index].line, points.points[i].line},
                   fmt::format("line {} repeats the place of line {}, which fits there.",
                               points.points[index].line, points.points[i].line));
  }
  return std::nullopt;
}

/// Pairs that are right with each other's place come first and are taken out of `left`.
std::vector<Finding> swapped_pairs(const FieldPoints& points, std::vector<Outlier>* left) {
  std::vector<Finding> findings;
  for (std::size_t a = 0; a < left->size(); ++a) {
    for (std::size_t b = a + 1; b < left->size(); ++b) {
      const FieldPoint& first = points.points[(*left)[a].index];
      const FieldPoint& second = points.points[(*left)[b].index];
      if (!is_right((*left)[a], second.position_m) || !is_right((*left)[b], first.position_m)) {
        continue;
      }
      findings.push_back(failure("swapped points", {first.line, second.line},
                                 fmt::format("lines {} and {} are swapped: each has the other's "
                                             "place.",
                                             first.line, second.line)));
      left->erase(left->begin() + static_cast<std::ptrdiff_t>(b));
      left->erase(left->begin() + static_cast<std::ptrdiff_t>(a));
      --a;
      break;
    }
  }
  return findings;
}

Finding explanation(const FieldPoints& points, const Outlier& outlier,
                    const std::vector<Outlier>& all) {
  if (auto slip = undone_slip(points, outlier)) return *slip;
  if (auto copy = copied_place(points, outlier.index, all)) return *copy;
  Finding finding = typing_error(points.points[outlier.index], outlier,
                                 "A typing error, or another point's pixel?");
  if (outlier.distance_px < kSurelyTyped_px) finding.grade = Grade::kWarn;
  return finding;
}

}  // namespace

std::vector<Finding> point_findings(const FieldPoints& points, const RobustReference& reference,
                                    const StatedNoise& noise) {
  const std::vector<Outlier> all = outliers(points, reference, noise);
  const auto count = static_cast<double>(points.points.size());
  if (static_cast<double>(all.size()) > kMixedUpShare * count) {
    return {failure("mixed up", {},
                    fmt::format("{} of {} points do not fit the others: were rows mixed up or left "
                                "out in one of the columns?",
                                all.size(), points.points.size()))};
  }
  std::vector<Outlier> left = all;
  std::vector<Finding> findings = swapped_pairs(points, &left);
  for (const Outlier& outlier : left) {
    if (findings.size() >= kMostListed) break;
    findings.push_back(explanation(points, outlier, all));
  }
  return findings;
}

}  // namespace nadir::calibration
