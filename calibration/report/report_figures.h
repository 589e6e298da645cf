#pragma once

#include <string>

#include "calibration/report/report_numbers.h"

namespace nadir::calibration {

// The figures of a report, each one <svg> element of the same width.

/// Residuals of all points on the field, as arrows enlarged to be seen; those of the worst points
/// in another colour.
std::string residual_arrows(const FieldPoints& points, const FieldResult& result,
                            const ReportNumbers& numbers);
/// Which way each residual points, over the image: noise is a medley, a model that does not fit
/// shows patches of one colour.
std::string residual_directions(const FieldPoints& points, const FieldResult& result,
                                const ReportNumbers& numbers);
/// Residuals per axis over their stated sigma, and the normal distribution.
std::string residual_histogram(const FieldResult& result, const ReportNumbers& numbers);
/// The calibration's own error over the field, one sigma in mm, with the hull of the points.
std::string error_map(const FieldPoints& points, const FieldResult& result,
                      const ReportNumbers& numbers);
/// What two halves of the points disagree by, in mm.
std::string half_difference_map(const FieldResult& result, const ReportNumbers& numbers);
/// Points in the parts of the image.
std::string coverage_map(const FieldPoints& points, const FieldResult& result,
                         const ReportNumbers& numbers);

}  // namespace nadir::calibration
