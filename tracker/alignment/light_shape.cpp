#include "tracker/alignment/light_shape.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace nadir::tracker {
namespace {

constexpr double kFirstDeviation = 0.1;   // of a coefficient: light may change by so much
constexpr double kMostSlopePerPx = 4e-3;  // more is a shadow's edge
constexpr int kSolveEvery = 64;
constexpr double kMemory = 0.999;  // per slope: lamps are switched on and off

}  // namespace

LightShape::LightShape(int width_px, int height_px)
    : middle_px_(0.5 * (width_px - 1), 0.5 * (height_px - 1)),
      half_px_(0.5 * std::max(width_px, height_px)),
      information_(Eigen::Matrix<double, 5, 5>::Identity() / (kFirstDeviation * kFirstDeviation)) {}

LightShape::Basis LightShape::basis(const vision::PixelPoint& pixel) const {
  const Eigen::Vector2d at = (pixel - middle_px_) / half_px_;
  Basis result;
  result << 1.0, 0.0, 2.0 * at.x(), at.y(), 0.0,  //
      0.0, 1.0, 0.0, at.x(), 2.0 * at.y();
  return result / half_px_;
}

Eigen::Vector2d LightShape::slope_per_px(const vision::PixelPoint& pixel) const {
  return basis(pixel) * coefficients_;
}

void LightShape::learn(const vision::PixelPoint& pixel, const Eigen::Vector2d& slope_per_px,
                       double variance_per_px2) {
  if (!(slope_per_px.norm() < kMostSlopePerPx)) return;
  const Basis b = basis(pixel);
  const double floor = 1.0 / (kFirstDeviation * kFirstDeviation);
  information_ *= kMemory;
  information_.diagonal().array() += (1.0 - kMemory) * floor;
  gradient_ *= kMemory;
  information_ += b.transpose() * b / variance_per_px2;
  gradient_ += b.transpose() * slope_per_px / variance_per_px2;
  if (++learnt_ % kSolveEvery == 0) coefficients_ = information_.ldlt().solve(gradient_);
}

}  // namespace nadir::tracker
