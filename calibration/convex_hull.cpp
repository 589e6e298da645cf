#include "calibration/convex_hull.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace nadir::calibration {
namespace {

using vision::PixelPoint;

/// Twice the area of the triangle a, b, c: positive for a left turn.
double turn(const PixelPoint& a, const PixelPoint& b, const PixelPoint& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// One half of the chain: the points in order, without those at which it turns right or not at all.
void append_chain(const std::vector<PixelPoint>& sorted, std::vector<PixelPoint>* chain) {
  const std::size_t first = chain->size();
  for (const PixelPoint& pixel : sorted) {
    while (chain->size() >= first + 2 &&
           turn((*chain)[chain->size() - 2], chain->back(), pixel) <= 0.0) {
      chain->pop_back();
    }
    chain->push_back(pixel);
  }
  chain->pop_back();  // it begins the other half
}

PixelPoint nearest_on_edge(const PixelPoint& a, const PixelPoint& b, const PixelPoint& pixel) {
  const PixelPoint along = b - a;
  const double length2 = along.squaredNorm();
  if (length2 == 0.0) return a;
  return a + std::clamp((pixel - a).dot(along) / length2, 0.0, 1.0) * along;
}

}  // namespace

ConvexHull ConvexHull::of(std::vector<PixelPoint> pixels) {
  const auto is_less = [](const PixelPoint& a, const PixelPoint& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(pixels.begin(), pixels.end(), is_less);
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  ConvexHull hull;
  if (pixels.size() < 3) {
    hull.vertices_ = std::move(pixels);
    return hull;
  }
  append_chain(pixels, &hull.vertices_);
  std::reverse(pixels.begin(), pixels.end());
  append_chain(pixels, &hull.vertices_);
  return hull;
}

ConvexHull::ConvexHull(std::vector<PixelPoint> vertices) : vertices_(std::move(vertices)) {
  const std::size_t count = vertices_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!vertices_[i].allFinite()) throw std::invalid_argument("convex hull: not finite");
    const bool turns_left = count < 3 || turn(vertices_[i], vertices_[(i + 1) % count],
                                              vertices_[(i + 2) % count]) > 0.0;
    if (!turns_left) throw std::invalid_argument("convex hull: not convex");
  }
}

bool ConvexHull::holds(const PixelPoint& pixel) const {
  const std::size_t count = vertices_.size();
  if (count == 0) return true;
  if (count < 3) return nearest(pixel) == pixel;
  for (std::size_t i = 0; i < count; ++i) {
    // Written so that a NaN is not inside.
    if (!(turn(vertices_[i], vertices_[(i + 1) % count], pixel) >= 0.0)) return false;
  }
  return true;
}

PixelPoint ConvexHull::nearest(const PixelPoint& pixel) const {
  const std::size_t count = vertices_.size();
  if (count == 0 || (count >= 3 && holds(pixel))) return pixel;
  PixelPoint best = vertices_.front();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const PixelPoint place = nearest_on_edge(vertices_[i], vertices_[(i + 1) % count], pixel);
    const double distance2 = (place - pixel).squaredNorm();
    if (distance2 >= least) continue;
    least = distance2;
    best = place;
  }
  return best;
}

double ConvexHull::area_px2() const {
  double twice = 0.0;
  for (std::size_t i = 2; i < vertices_.size(); ++i) {
    twice += turn(vertices_[0], vertices_[i - 1], vertices_[i]);
  }
  return 0.5 * twice;
}

}  // namespace nadir::calibration
