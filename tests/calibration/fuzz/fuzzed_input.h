#pragma once

#include <string>

namespace nadir::calibration {

/// Reads `text` as a points file and fits it as `nadir-calibrate field --model auto` does. Returns
/// false where it is refused with one of the errors that the program knows; true where a map came
/// out. Aborts where that map is not sound: a fit that is silently worthless.
bool fits_points(const std::string& text);

/// Reads `text` as a calibration file. Returns false where it is refused; true where it is read,
/// after a look at what it maps. Aborts where a sound file does not survive being written again.
bool reads_calibration(const std::string& text);

}  // namespace nadir::calibration
