#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/fit/fit.h"

namespace nadir::calibration {

/// Each point's error, surveyed minus mapped place, m, under the map that would be fitted without
/// it, without fitting again (Cook and Weisberg, Residuals and Influence in Regression, 1982):
///
///     e' = (I - H)^-1 e,   H = D M^-1 D^T W
///
/// exact for polynomials (W = I), to first order for cameras (W = s^2 (J J^T)^-1, radial_map.h).
/// `bare_map` is what fit_map made of the points. Infinite where a point alone determines a
/// parameter.
std::vector<Eigen::Vector2d> leave_one_out_errors_m(const PlaneMap& bare_map,
                                                    const FieldPoints& points);

/// Whether what is left is what the stated noise leaves.
struct ChiSquareTest {
  double chi_square = 0.0;     ///< sum of e^T (J C J^T + S)^-1 e over the points
  int degrees_of_freedom = 0;  ///< 2 n - parameters, above 0
  double p_value = 0.0;        ///< of as much or more, if the model fits and the noise is as stated
};

/// Nothing without stated noise, or without degrees of freedom.
std::optional<ChiSquareTest> lack_of_fit_test(const PlaneMap& map, const FieldPoints& points,
                                              const StatedNoise& noise);

/// Upper tail of chi-square by the cube root approximation (Wilson and Hilferty 1931).
double chi_square_tail(double chi_square, double degrees_of_freedom);

}  // namespace nadir::calibration
