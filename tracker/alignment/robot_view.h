#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <span>

#include "tracker/alignment/aligned_pose.h"
#include "tracker/alignment/disc_state.h"
#include "tracker/alignment/disc_template.h"
#include "tracker/alignment/light_shape.h"
#include "tracker/alignment/robot_place.h"

namespace nadir::tracker {

/// A frame as pixels are gathered from it; all of it must outlive the call.
struct FramePixels {
  const cv::Mat& image;
  Mosaic mosaic;
  const LightShape& light;
  vision::PixelFetch* meanwhile = nullptr;  ///< pixels of another robot, fetched between, or null
};

/// Decides which pixels tell of a robot's discs: those near a disc's edge, but not near the rim of
/// the robot's own plate, on other robots' plates, or nearer to another disc of the same robot.
class RobotView {
 public:
  /// `grid` must outlive the view.
  RobotView(const DiscTemplate& robot, const PlaneGrid& grid, const AlignmentSettings& settings)
      : robot_(robot), grid_(&grid), settings_(settings) {}

  /// Looks at a robot near a place; `near_px` is roughly where the image shows it. False where that
  /// cannot be found.
  bool aim(const RobotPlace& place, const vision::PixelPoint& near_px, double blur_px,
           std::span<const Obstacle> obstacles);
  /// Gathers one disc's pixels, of its edge only or all of them, for a place near the aim. False if
  /// none is in the image.
  bool gather(const FramePixels& frame, const RobotPlace& place, std::size_t disc, bool whole,
              DiscState& state) const;
  /// Discs whose edges are so near that their blurs meet.
  std::array<int, 2> neighbours_of(std::size_t disc) const;

  /// Where the image shows a place near the robot.
  vision::PixelPoint pixel(const Eigen::Vector2d& place_m) const {
    return middle_px_ + about_.offset_of(place_m);
  }
  double m_per_px() const { return m_per_px_; }  ///< about the robot
  double blur_px() const { return blur_px_; }
  DiscEdge edge(std::size_t disc) const { return {robot_.radius_m[disc], blur_px_}; }

 private:
  DiscTemplate robot_;
  const PlaneGrid* grid_;
  AlignmentSettings settings_;
  vision::PixelPoint middle_px_ = vision::PixelPoint::Zero();
  LocalPlane about_;  // the plane about it
  double m_per_px_ = 0.0;
  double blur_px_ = 0.0;
  PlateShape plate_;
  std::array<Obstacle, kMostObstacles> near_;
  int near_count_ = 0;
};

}  // namespace nadir::tracker
