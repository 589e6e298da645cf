#pragma once

#include <string>
#include <vector>

#include "calibration/pixel_count_variance.h"
#include "tests/bench/detector_noise.h"

namespace nadir::bench {

/// Variance against pixels per mark, place and heading, as SVG: measured and published for each
/// study (two at most), the 1/N law's, and the classes of the papers' tables.
std::string noise_figure(const std::vector<NoiseStudy>& studies,
                         const calibration::TableVariance& papers, double disc_distance_m);

}  // namespace nadir::bench
