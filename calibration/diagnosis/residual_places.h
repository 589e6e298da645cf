#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "calibration/diagnosis/residual_field.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// The residuals as the field sees them: of points or of neighbourhoods of points.
struct Places {
  std::vector<vision::PixelPoint> pixels;
  Eigen::MatrixX2d error_m;
  std::array<Eigen::MatrixXd, 2> design;  ///< of each axis: a row phi^T a place
  double noise_share = 1.0;               ///< variance of a place's noise against a point's
};

/// Each point, or the means over as many neighbourhoods as the field can take. The mean of the
/// basis keeps what is linear exact.
Places places_of(const FitResiduals& fit);

/// A: orthonormal columns, A^T design = 0.
Eigen::MatrixXd contrast_basis(const Eigen::MatrixXd& design);

/// Of full rank or not: directions of the parameters that move nothing have no part in the inverse.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& design);

}  // namespace nadir::calibration
