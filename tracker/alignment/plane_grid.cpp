#include "tracker/alignment/plane_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace nadir::tracker {
namespace {

constexpr int kMostNewtonSteps = 8;
constexpr double kConverged_px = 1e-4;

}  // namespace

Eigen::Vector2d LocalPlane::at(double du, double dv) const {
  return origin_m + slope * Eigen::Vector2d(du, dv) +
         bend * Eigen::Vector3d(du * du, du * dv, dv * dv);
}

Eigen::Vector2d LocalPlane::offset_of(const Eigen::Vector2d& place_m) const {
  const Eigen::Matrix2d inverse = slope.inverse();
  const Eigen::Vector2d first = inverse * (place_m - origin_m);
  const Eigen::Vector2d second = first + inverse * (place_m - at(first.x(), first.y()));
  return second + inverse * (place_m - at(second.x(), second.y()));
}

LocalPlane LocalPlane::moved(double du, double dv) const {
  LocalPlane result = *this;
  result.origin_m = at(du, dv);
  result.slope.col(0) += 2.0 * du * bend.col(0) + dv * bend.col(1);
  result.slope.col(1) += du * bend.col(1) + 2.0 * dv * bend.col(2);
  return result;
}

PlaneGrid::PlaneGrid(const calibration::PlaneMap& map, int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      columns_((width_px - 1) / kSpacing_px + 2),
      rows_((height_px - 1) / kSpacing_px + 2) {
  nodes_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  constexpr double kHalf = 0.5 * kSpacing_px;
  double finest_m2_per_px2 = std::numeric_limits<double>::infinity();
  const auto jacobian = [&map](double u, double v) -> Eigen::Matrix2d {
    return map.jacobian_m_per_px({u, v});
  };
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const double u = column * kSpacing_px;
      const double v = row * kSpacing_px;
      const Eigen::Matrix2d slope = jacobian(u, v);
      // Second derivatives by central differences of the first ones.
      const Eigen::Matrix2d by_u = (jacobian(u + kHalf, v) - jacobian(u - kHalf, v)) / kSpacing_px;
      const Eigen::Matrix2d by_v = (jacobian(u, v + kHalf) - jacobian(u, v - kHalf)) / kSpacing_px;
      Eigen::Matrix<double, 2, 3> bend;
      bend << 0.5 * by_u.col(0), 0.5 * (by_u.col(1) + by_v.col(0)), 0.5 * by_v.col(1);
      nodes_.push_back({map.plane_from_pixel({u, v}), slope.cast<float>(), bend.cast<float>()});
      finest_m2_per_px2 = std::min(finest_m2_per_px2, std::abs(slope.determinant()));
    }
  }
  finest_m_per_px_ = std::sqrt(finest_m2_per_px2);
}

std::array<int, 2> PlaneGrid::nearest(int u, int v) const {
  return {std::clamp((u + kSpacing_px / 2) / kSpacing_px, 0, columns_ - 1),
          std::clamp((v + kSpacing_px / 2) / kSpacing_px, 0, rows_ - 1)};
}

LocalPlane PlaneGrid::about(int u, int v) const {
  const std::array<int, 2> at = nearest(u, v);
  const Node& from = node(at);
  return LocalPlane{from.origin_m, from.slope.cast<double>(), from.bend.cast<double>()}.moved(
      u - at[0] * kSpacing_px, v - at[1] * kSpacing_px);
}

void PlaneGrid::fetch(const vision::PixelPoint& pixel) const {
  __builtin_prefetch(&node(nearest(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()))));
}

Eigen::Vector2d PlaneGrid::plane_from_pixel(const vision::PixelPoint& pixel) const {
  const int u = static_cast<int>(std::lround(std::clamp(pixel.x(), -1e4, 1e5)));
  const int v = static_cast<int>(std::lround(std::clamp(pixel.y(), -1e4, 1e5)));
  return about(u, v).at(pixel.x() - u, pixel.y() - v);
}

double PlaneGrid::metres_per_pixel(const vision::PixelPoint& pixel) const {
  const LocalPlane plane =
      about(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
  return std::sqrt(std::abs(plane.slope.determinant()));
}

std::optional<vision::PixelPoint> PlaneGrid::pixel_near(const Eigen::Vector2d& place_m,
                                                        const vision::PixelPoint& guess) const {
  vision::PixelPoint pixel = guess;
  const double far_px = 2.0 * (width_px_ + height_px_);
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    if (!(pixel.cwiseAbs().maxCoeff() < far_px)) return std::nullopt;
    const int u = static_cast<int>(std::lround(pixel.x()));
    const int v = static_cast<int>(std::lround(pixel.y()));
    const LocalPlane plane = about(u, v);
    const Eigen::Vector2d offset = pixel - vision::PixelPoint(u, v);
    const LocalPlane here = plane.moved(offset.x(), offset.y());
    const Eigen::Vector2d change = here.slope.inverse() * (place_m - here.origin_m);
    pixel += change;
    if (change.squaredNorm() < kConverged_px * kConverged_px) return pixel;
  }
  return std::nullopt;
}

}  // namespace nadir::tracker
