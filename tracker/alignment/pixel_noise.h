#pragma once

namespace nadir::tracker {

/// Variance of a pixel value of level L: read + shot L, grey levels squared.
struct PixelNoise {
  double read = 0.3;
  double shot = 0.03;

  double variance(double level) const { return read + shot * (level > 0.0 ? level : 0.0); }
};

/// How pixels are limited that do not belong there: beyond `huber` sigmas their pull stays the
/// same, beyond `far` sigmas it fades with their distance.
struct OutlierLimits {
  double huber_sigmas = 2.5;
  double far_sigmas = 1e9;
};

}  // namespace nadir::tracker
