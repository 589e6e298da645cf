#pragma once

#include <string>

#include "calibration/report/report_numbers.h"

namespace nadir::calibration {

/// `field_json`, the JSON object that `nadir-calibrate field` writes, with what the report's
/// figures show: "own_error", "half_data", "coverage", "histogram".
std::string with_report_numbers(const std::string& field_json, const ReportNumbers& numbers);

}  // namespace nadir::calibration
