#include "tracker/alignment/robot_view.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace nadir::tracker {
namespace {

constexpr double kReach_sigmas = 2.7;  // so far reach the edges of two neighbours together
constexpr double kNear_px = 3.0;       // that an obstacle may have moved
constexpr double kWholeMargin_sigmas = 3.0;

}  // namespace

bool RobotView::aim(const RobotPlace& place, const vision::PixelPoint& near_px, double blur_px,
                    std::span<const Obstacle> obstacles) {
  const Eigen::Vector2d place_m = place.pose().position_m();
  const auto pixel = grid_->pixel_near(place_m, near_px);
  if (!pixel) return false;
  middle_px_ = {std::round(pixel->x()), std::round(pixel->y())};
  about_ = grid_->about(static_cast<int>(middle_px_.x()), static_cast<int>(middle_px_.y()));
  m_per_px_ = std::sqrt(std::abs(about_.slope.determinant()));
  blur_px_ = blur_px;
  const double rim_m = settings_.rim_sigmas * blur_px_ * m_per_px_;
  near_count_ = 0;
  for (const Obstacle& obstacle : obstacles) {
    const double apart_m = (obstacle.place_m - place_m).norm();
    if (near_count_ == kMostObstacles ||
        apart_m > obstacle.radius_m + robot_.plate.radius_m + rim_m + kNear_px * m_per_px_) {
      continue;
    }
    near_[static_cast<std::size_t>(near_count_++)] = {obstacle.place_m, obstacle.radius_m + rim_m};
  }
  // Of a far robot's outermost discs half at least must stay, though the rim's blur reaches them.
  const double own_rim_m = std::min(rim_m, robot_.plate.radius_m - robot_.least_plate_m);
  plate_ = {robot_.plate.radius_m - own_rim_m, robot_.plate.front_m - own_rim_m};
  return true;
}

std::array<int, 2> RobotView::neighbours_of(std::size_t disc) const {
  std::array<int, 2> neighbours{-1, -1};
  std::size_t count = 0;
  const auto disc_count = static_cast<std::size_t>(robot_.disc_count);
  const double reach_m = 2.0 * kReach_sigmas * blur_px_ * m_per_px_;
  for (std::size_t k = 0; k < disc_count && count < neighbours.size(); ++k) {
    const double gap_m = (robot_.place_m[disc] - robot_.place_m[k]).norm() - robot_.radius_m[disc] -
                         robot_.radius_m[k];
    if (k != disc && gap_m <= reach_m) neighbours[count++] = static_cast<int>(k);
  }
  return neighbours;
}

bool RobotView::gather(const FramePixels& frame, const RobotPlace& place, std::size_t disc,
                       bool whole, DiscState& state) const {
  const Eigen::Vector2d centre_m = place.point(robot_.place_m[disc]);
  PatchWindow window;
  window.centre_m = centre_m;
  window.centre_px = pixel(centre_m);
  window.radius_m = robot_.radius_m[disc];
  window.margin_px = (whole ? kWholeMargin_sigmas : settings_.margin_sigmas) * blur_px_;
  window.whole = whole;
  window.light_slope_per_px = frame.light.slope_per_px(window.centre_px);
  window.meanwhile = frame.meanwhile;
  const auto far = [&](double at, int size) { return !(at > -size && at < 2.0 * size); };
  if (far(window.centre_px.x(), frame.image.cols) || far(window.centre_px.y(), frame.image.rows) ||
      !tracker::gather(frame.image, frame.mosaic, *grid_, window, state.patch)) {
    return false;
  }
  mask(plate_, place.pose().position_m(), place.forward(), near_.data(), near_count_, state.patch);
  state.neighbours = neighbours_of(disc);
  for (const int other : state.neighbours) {
    if (other < 0) continue;
    const auto k = static_cast<std::size_t>(other);
    leave_to(centre_m, robot_.radius_m[disc], place.point(robot_.place_m[k]), robot_.radius_m[k],
             state.patch);
  }
  return true;
}

}  // namespace nadir::tracker
