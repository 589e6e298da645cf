#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace nadir::calibration {

/// Reads one picture, CV_8UC3. Throws InputError: missing, incomplete, not a picture.
cv::Mat load_picture(const std::string& file);

/// Writes one picture in the format of its name's ending. Throws InputError where it cannot.
void write_picture(const std::string& file, const cv::Mat& picture);

}  // namespace nadir::calibration
