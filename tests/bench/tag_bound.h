#pragma once

#include <Eigen/Core>

#include "vision/synthetic/renderer.h"

namespace nadir::bench {

/// The Cramer-Rao bound of a tag's pose, from the renderer's own derivatives and the sensor's true
/// noise (shot, read, rounding): x, y (m) and heading (rad). Black and white of each channel are
/// nuisance; what lies beyond the print, and what its blurred rim hides, is not known. For a robot
/// with one tag; with a mosaic, of the samples that the sensor took. Gamma 1 only.
Eigen::Matrix3d tag_bound(const vision::Scene& scene, const vision::RobotPlacement& robot);

}  // namespace nadir::bench
