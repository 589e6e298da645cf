#pragma once

#include <string>

#include "calibration/field_calibration.h"
#include "calibration/field_points.h"
#include "calibration/report/report_numbers.h"

namespace nadir::calibration {

/// All that is known of a calibration on one page: grade, remarks, figures, models, worst points.
/// HTML with its figures inside; needs no network and no script, follows a dark browser, prints in
/// black on white.
std::string report_html(const FieldPoints& points, const FieldResult& result,
                        const ReportNumbers& numbers);

}  // namespace nadir::calibration
