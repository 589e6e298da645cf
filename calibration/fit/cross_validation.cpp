#include "calibration/fit/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

constexpr int kFolds = 5;
/// Blocks in a row and in a column: as many as have about four points each.
constexpr double kPointsOfBlock = 4.0;
constexpr int kFewestSides = 5;
constexpr int kMostSides = 10;

int sides(const FieldPoints& points) {
  const double wanted = std::sqrt(static_cast<double>(points.points.size()) / kPointsOfBlock);
  return std::clamp(static_cast<int>(std::lround(wanted)), kFewestSides, kMostSides);
}

/// Where a point is held out.
struct Block {
  int number = 0;  ///< row by row
  int fold = 0;
};

/// Every row and every column of blocks has each fold, and no two neighbours are of one fold.
std::vector<Block> blocks(const FieldPoints& points) {
  const int count = sides(points);
  const PixelBox box = pixel_box(points);
  const Eigen::Vector2d extent_px = (box.high_px - box.low_px).cwiseMax(1e-9);
  std::vector<Block> result;
  result.reserve(points.points.size());
  for (const FieldPoint& point : points.points) {
    const Eigen::Vector2d share = (point.pixel - box.low_px).cwiseQuotient(extent_px);
    const int column = std::clamp(static_cast<int>(share.x() * count), 0, count - 1);
    const int row = std::clamp(static_cast<int>(share.y() * count), 0, count - 1);
    result.push_back({row * count + column, (column + 2 * row) % kFolds});
  }
  return result;
}

/// The map without a fold; nothing where the other points do not determine it.
std::optional<PlaneMap> map_without(int fold, ModelKind model, const FieldPoints& points,
                                    const std::vector<Block>& block, const FitOptions& options) {
  FieldPoints others{points.file, {}};
  FitOptions others_options{options.lens_centre_px, {}};
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (block[i].fold == fold) continue;
    others.points.push_back(points.points[i]);
    if (!options.weights.empty()) others_options.weights.push_back(options.weights[i]);
  }
  try {
    return fit_map(model, others, others_options);
  } catch (const vision::InputError&) {
    return std::nullopt;
  }
}

/// Mean square and its standard error, from the blocks as independent samples:
/// Var(sum) = m / (m - 1) sum of (S_b - n_b mean)^2.
void summarise(const std::vector<Block>& block, ModelScore* score) {
  std::vector<double> sums_m2(static_cast<std::size_t>(kMostSides) * kMostSides, 0.0);
  std::vector<double> counts(sums_m2.size(), 0.0);
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const double square_m2 = score->error_m[i].squaredNorm();
    sums_m2[static_cast<std::size_t>(block[i].number)] += square_m2;
    counts[static_cast<std::size_t>(block[i].number)] += 1.0;
    sum_m2 += square_m2;
  }
  const auto count = static_cast<double>(block.size());
  const double mean_m2 = sum_m2 / count;
  double spread = 0.0;
  double used = 0.0;
  for (std::size_t b = 0; b < sums_m2.size(); ++b) {
    if (counts[b] == 0.0) continue;
    used += 1.0;
    spread += std::pow(sums_m2[b] - counts[b] * mean_m2, 2);
  }
  score->cross_validated_rms_m = std::sqrt(mean_m2);
  score->standard_error_m2 = used > 1.0 ? std::sqrt(used / (used - 1.0) * spread) / count : mean_m2;
}

}  // namespace

ModelScore cross_validate(ModelKind model, const FieldPoints& points, const FitOptions& options) {
  ModelScore score;
  score.model = model;
  if (points.points.size() < static_cast<std::size_t>(parameter_count(model))) return score;
  const std::vector<Block> block = blocks(points);
  std::vector<Eigen::Vector2d> error_m(points.points.size());
  double residual_m2 = 0.0;
  try {
    const PlaneMap all = fit_map(model, points, options);
    for (const FieldPoint& point : points.points) {
      residual_m2 += (point.position_m - all.plane_from_pixel(point.pixel)).squaredNorm();
    }
  } catch (const vision::InputError&) {
    return score;
  }
  for (int fold = 0; fold < kFolds; ++fold) {
    const std::optional<PlaneMap> map = map_without(fold, model, points, block, options);
    if (!map) return score;
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      if (block[i].fold != fold) continue;
      error_m[i] = points.points[i].position_m - map->plane_from_pixel(points.points[i].pixel);
      if (!error_m[i].allFinite()) return score;
    }
  }
  score.is_fitted = true;
  score.residual_rms_m = std::sqrt(residual_m2 / static_cast<double>(points.points.size()));
  score.error_m = std::move(error_m);
  summarise(block, &score);
  return score;
}

ModelKind chosen_model(const std::vector<ModelScore>& scores) {
  const ModelScore* best = nullptr;
  for (const ModelScore& score : scores) {
    if (!score.is_fitted) continue;
    if (!best || score.cross_validated_rms_m < best->cross_validated_rms_m) best = &score;
  }
  if (!best) return ModelKind::kPolynomial2;
  const double limit_m2 = std::pow(best->cross_validated_rms_m, 2) + best->standard_error_m2;
  for (const ModelScore& score : scores) {
    if (score.is_fitted && std::pow(score.cross_validated_rms_m, 2) <= limit_m2) return score.model;
  }
  return best->model;
}

ModelChoice choose_model(const FieldPoints& points, const FitOptions& options) {
  ModelChoice choice;
  for (const ModelKind model : kAllModels) {
    choice.scores.push_back(cross_validate(model, points, options));
  }
  choice.model = chosen_model(choice.scores);
  return choice;
}

}  // namespace nadir::calibration
