#include "calibration/diagnosis/lack_of_fit.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace nadir::calibration {
namespace {

/// Where a pixel lies on one side of the grid: between `low` and `high`, at `share` of the way.
struct GridPlace {
  int low = 0;
  int high = 0;
  double share = 0.0;
};

GridPlace grid_place(double pixel_px, double low_px, double high_px, int count) {
  if (count == 1) return {};
  const double last = count - 1;
  // A NaN ends at the low border.
  const double place =
      std::min(last, std::max(0.0, (pixel_px - low_px) / (high_px - low_px) * last));
  const int low = std::min(count - 2, static_cast<int>(place));
  return {low, low + 1, place - low};
}

}  // namespace

LackOfFit LackOfFit::uniform(double variance_m2) {
  return {{}, 1, 1, {{Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(variance_m2)}}};
}

LackOfFit::LackOfFit(const PixelBox& box, int columns, int rows, std::vector<LackOfFitNode> nodes)
    : box_(box), columns_(columns), rows_(rows), nodes_(std::move(nodes)) {
  const Eigen::Vector2d extent_px = box_.high_px - box_.low_px;
  if (columns_ < 1 || rows_ < 1 ||
      nodes_.size() != static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    throw std::invalid_argument("lack of fit: sizes do not belong together");
  }
  if (!extent_px.allFinite() || (columns_ > 1 && !(extent_px.x() > 0.0)) ||
      (rows_ > 1 && !(extent_px.y() > 0.0))) {
    throw std::invalid_argument("lack of fit: the box has no extent");
  }
  const bool is_sound = std::all_of(nodes_.begin(), nodes_.end(), [](const LackOfFitNode& node) {
    return node.error_m.allFinite() && node.variance_m2.allFinite() &&
           node.variance_m2.minCoeff() >= 0.0;
  });
  if (!is_sound) throw std::invalid_argument("lack of fit: number out of range");
}

Eigen::Vector2d LackOfFit::mean_square_m2(const vision::PixelPoint& pixel) const {
  const GridPlace u = grid_place(pixel.x(), box_.low_px.x(), box_.high_px.x(), columns_);
  const GridPlace v = grid_place(pixel.y(), box_.low_px.y(), box_.high_px.y(), rows_);
  Eigen::Vector2d error_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d variance_m2 = Eigen::Vector2d::Zero();
  const auto add = [&](int column, int row, double weight) {
    const LackOfFitNode& node =
        nodes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column)];
    error_m += weight * node.error_m;
    variance_m2 += weight * node.variance_m2;
  };
  add(u.low, v.low, (1.0 - u.share) * (1.0 - v.share));
  add(u.high, v.low, u.share * (1.0 - v.share));
  add(u.low, v.high, (1.0 - u.share) * v.share);
  add(u.high, v.high, u.share * v.share);
  return error_m.cwiseAbs2() + variance_m2;
}

}  // namespace nadir::calibration
