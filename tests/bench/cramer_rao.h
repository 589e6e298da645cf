#pragma once

#include <Eigen/Core>
#include <vector>

#include "vision/synthetic/renderer.h"

namespace nadir::bench {

/// The Cramer-Rao bound of a robot's pose: no estimate without bias that sees only the discs can be
/// better on average. From the renderer's own derivatives: central differences of the painted light
/// by x, y and heading, weighted with the sensor's true noise (shot, read, rounding), with a level
/// and a contrast for each disc and channel as nuisance. The plate has no rim here: what lies
/// beyond it is not known to an observer of discs. Sensors with gamma 1 only.
class CramerRaoBound {
 public:
  explicit CramerRaoBound(const vision::Scene& scene);

  /// Covariance of x, y (m) and heading (rad) of a robot of the scene's first layout in a frame.
  Eigen::Matrix3d covariance(const vision::RobotPlacement& robot, const vision::ShadowEdge* shadow);

 private:
  vision::Sprite sprite_of(const vision::RobotPlacement& robot) const;
  /// Grey levels, blue green red, of a region of the image.
  Eigen::MatrixXd light_of(const vision::Sprite& sprite, const vision::ShadowEdge* shadow,
                           const cv::Rect& region);

  vision::Scene scene_;
  vision::CameraModel camera_;
  vision::LightField light_;
  vision::SpritePainter painter_;
  vision::ImageSensor sensor_;
  vision::SpritePatch patch_;
};

}  // namespace nadir::bench
