#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "calibration/plane_map.h"
#include "vision/pixel.h"

namespace nadir::tracker {

/// The plane around one pixel: x = x0 + xu du + xv dv + xuu du^2 + xuv du dv + xvv dv^2 metres, y
/// alike, with (du, dv) the offset from that pixel.
struct LocalPlane {
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();                      ///< x0, y0
  Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();                         ///< [xu xv; yu yv]
  Eigen::Matrix<double, 2, 3> bend = Eigen::Matrix<double, 2, 3>::Zero();  ///< [xuu xuv xvv; ...]

  Eigen::Vector2d at(double du, double dv) const;
  /// The offset at which a place is, 30 px away at most: to second order of the bend.
  Eigen::Vector2d offset_of(const Eigen::Vector2d& place_m) const;
  /// The same plane, expanded about the pixel at that offset.
  LocalPlane moved(double du, double dv) const;
};

/// A plane map as a grid of local quadratics, 8 px apart: what a calibration costs to evaluate does
/// not matter any more. Exact for polynomials of order 2; for a lens with k1 = -0.2 and a focal
/// length of 600 px wrong by less than 0.001 px within 12 px of a place.
class PlaneGrid {
 public:
  PlaneGrid(const calibration::PlaneMap& map, int width_px, int height_px);

  /// About the pixel (u, v); places outside of the image continue the nearest node.
  LocalPlane about(int u, int v) const;
  /// Asks memory for what `about` will need there: the grid of a large picture is larger than
  /// caches.
  void fetch(const vision::PixelPoint& pixel) const;
  Eigen::Vector2d plane_from_pixel(const vision::PixelPoint& pixel) const;
  /// Square root of the area of a pixel.
  double metres_per_pixel(const vision::PixelPoint& pixel) const;
  /// Of the pixel that shows least of the plane, about.
  double finest_m_per_px() const { return finest_m_per_px_; }
  /// The pixel that shows a place, by Newton's method from a guess a few hundred pixels away at
  /// most; nothing if it does not end.
  std::optional<vision::PixelPoint> pixel_near(const Eigen::Vector2d& place_m,
                                               const vision::PixelPoint& guess) const;

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

 private:
  static constexpr int kSpacing_px = 8;

  /// A LocalPlane in one line of the cache: the grid of a large picture is larger than caches. What
  /// is not the place itself is multiplied by some pixels, so that single precision is good to
  /// 1e-8 m.
  struct alignas(64) Node {
    Eigen::Vector2d origin_m;
    Eigen::Matrix2f slope;
    Eigen::Matrix<float, 2, 3> bend;
  };

  /// Index of the node nearest to a pixel, as column and row.
  std::array<int, 2> nearest(int u, int v) const;
  const Node& node(const std::array<int, 2>& at) const {
    return nodes_[static_cast<std::size_t>(at[1]) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(at[0])];
  }

  int width_px_;
  int height_px_;
  int columns_;
  int rows_;
  double finest_m_per_px_ = 0.0;
  std::vector<Node> nodes_;
};

}  // namespace nadir::tracker
