#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/colour_classes.h"
#include "vision/local_scale.h"
#include "vision/pixel.h"

namespace nadir::vision {

/// Looks at the single pixels that lie at many offsets from one place at once.
class HueProbe {
 public:
  static constexpr float kOutside = -1e6F;  ///< hue of a place out of the image

  /// `offsets_m`: on the marker plane, in the world's directions.
  HueProbe(const std::vector<Eigen::Vector2f>& offsets_m, std::vector<ColourScore> colours);

  /// For each offset from `centre`: how much of the best of the colours is in the nearest pixel's
  /// difference from `surroundings`. Valid until the next call.
  const std::vector<float>& look(const cv::Mat& bgr, const LocalScale& scale,
                                 const PixelPoint& centre, const Bgr& surroundings);

 private:
  std::vector<ColourScore> colours_;
  std::vector<float> x_m_;
  std::vector<float> y_m_;
  std::vector<int> place_;      ///< offset of the pixel's first byte
  std::vector<float> outside_;  ///< 0 or kOutside
  std::vector<float> blue_;
  std::vector<float> green_;
  std::vector<float> red_;
  std::vector<float> hue_;
};

}  // namespace nadir::vision
