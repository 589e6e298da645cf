#pragma once

#include "tracker/alignment/light_shape.h"
#include "tracker/alignment/pixel_noise.h"

namespace nadir::tracker {

/// What the discs of one camera tell of its optics and its sensor: how wide edges are blurred,
/// how noisy values are and how the light runs over the picture. Learnt from every robot that is
/// aligned, so that nobody has to state it; starts from values of a usual camera.
class SensorModel {
 public:
  SensorModel(int width_px, int height_px) : light(width_px, height_px) {}

  double blur_px() const { return blur_px_; }
  const PixelNoise& noise() const { return noise_; }

  /// A level, the mean square of `count` residuals about it.
  void learn_noise(double level, double mean_square, double count);
  /// The derivative of the log likelihood by the blur, and its information (1 / px^2).
  void learn_blur(double score, double information);

  /// Standard deviation of the blur as far as noise makes it, px.
  double blur_deviation_px() const;

  LightShape light;

 private:
  void solve_noise();

  static constexpr double kFirstBlur_px = 0.8;
  static constexpr double kFirstBlurDeviation_px = 0.2;

  double blur_px_ = kFirstBlur_px;
  double blur_information_ = 1.0 / (kFirstBlurDeviation_px * kFirstBlurDeviation_px);
  PixelNoise noise_;
  // Weighted least squares of variance = read + shot * level.
  double weight_ = 0.0, weight_level_ = 0.0, weight_level2_ = 0.0;
  double weight_square_ = 0.0, weight_level_square_ = 0.0;
};

}  // namespace nadir::tracker
