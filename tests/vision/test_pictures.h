#pragma once

#include <opencv2/core.hpp>

namespace nadir::vision {

/// A smooth colour picture that differs from index to index; any codec reproduces it well.
inline cv::Mat test_picture(int width_px, int height_px, int index) {
  cv::Mat image(height_px, width_px, CV_8UC3);
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      image.at<cv::Vec3b>(v, u) = cv::Vec3b(static_cast<uchar>(40 + 100 * u / width_px),
                                            static_cast<uchar>(60 + 20 * index),
                                            static_cast<uchar>(200 - 100 * v / height_px));
    }
  }
  return image;
}

}  // namespace nadir::vision
