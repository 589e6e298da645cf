#include "tracker/alignment/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace nadir::tracker {
namespace {

constexpr double kLeastBlur_px = 0.35;
constexpr double kMostBlur_px = 3.0;
constexpr double kMostBlurStep_px = 0.1;
// The blur may change (focus, temperature): what was learnt weighs no more than this.
constexpr double kMostBlurInformation = 1.0 / (0.002 * 0.002);
constexpr double kPriorCount = 100.0;  // residuals that the first guess of the noise is worth
constexpr double kMostCount = 2e5;
constexpr double kLeastRead = 1.0 / 12.0;  // of the rounding to whole grey levels
constexpr double kTypicalLevel = 60.0;

}  // namespace

void SensorModel::learn_noise(double level, double mean_square, double count) {
  // A mean square of normal residuals has the variance 2 v^2 / count.
  const double variance = noise_.variance(level);
  const double weight = count / (2.0 * variance * variance);
  weight_ += weight;
  weight_level_ += weight * level;
  weight_level2_ += weight * level * level;
  weight_square_ += weight * mean_square;
  weight_level_square_ += weight * level * mean_square;
  const double most = kMostCount / (2.0 * variance * variance);
  if (weight_ > most) {
    for (double* sum :
         {&weight_, &weight_level_, &weight_level2_, &weight_square_, &weight_level_square_}) {
      *sum *= 0.5;
    }
  }
  solve_noise();
}

void SensorModel::solve_noise() {
  // The first guess counts as residuals at level 0 and at a typical one.
  const PixelNoise first{};
  double n = weight_;
  double l = weight_level_;
  double ll = weight_level2_;
  double s = weight_square_;
  double ls = weight_level_square_;
  for (const double level : {0.0, kTypicalLevel}) {
    const double variance = first.variance(level);
    const double weight = kPriorCount / (2.0 * variance * variance);
    n += weight;
    l += weight * level;
    ll += weight * level * level;
    s += weight * variance;
    ls += weight * level * variance;
  }
  const double determinant = n * ll - l * l;
  if (!(determinant > 0.0)) return;
  double shot = std::max(0.0, (n * ls - l * s) / determinant);
  double read = (s - shot * l) / n;
  if (read < kLeastRead) {  // the best line through the least read noise
    read = kLeastRead;
    shot = std::max(0.0, (ls - read * l) / ll);
  }
  noise_ = {read, shot};
}

void SensorModel::learn_blur(double score, double information) {
  if (!(information > 0.0)) return;
  blur_information_ = std::min(blur_information_ + information, kMostBlurInformation);
  const double step = std::clamp(score / blur_information_, -kMostBlurStep_px, kMostBlurStep_px);
  blur_px_ = std::clamp(blur_px_ + step, kLeastBlur_px, kMostBlur_px);
}

double SensorModel::blur_deviation_px() const { return 1.0 / std::sqrt(blur_information_); }

}  // namespace nadir::tracker
