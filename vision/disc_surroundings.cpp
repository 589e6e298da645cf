#include "vision/disc_surroundings.h"

#include <algorithm>
#include <cmath>

namespace nadir::vision {
namespace {

constexpr int kLeastOfPlate = 4;               // samples of the ring that show it is seen there
constexpr float kSameColour2 = 0.15F * 0.15F;  // of the contrast: samples of one colour differ less
// A second colour of the surroundings: this share in the disc at least, not further from the line
// than what still counts, and in so many of the ring's samples; ...
constexpr float kLeastSecondShare = 0.12F;
constexpr float kForeign2 = 0.245F;
constexpr int kLeastSecondSamples = 2;
constexpr float kLeastTurnedContrast2 = 0.2F;  // ... and what must be left of the contrast squared

// How many samples of the ring differ from a colour by no more than this, and their mean.
int samples_near(const Ring& ring, const Bgr& colour, float distance2, Bgr& mean) {
  Bgr sum = Bgr::Zero();
  int count = 0;
  for (int i = 0; i < kRingSamples; ++i) {
    const Bgr value(ring[0][i], ring[1][i], ring[2][i]);
    if ((value - colour).squaredNorm() > distance2) continue;
    sum += value;
    ++count;
  }
  mean = sum / static_cast<float>(std::max(1, count));
  return count;
}

}  // namespace

Bgr surroundings_of(const Ring& ring, const Bgr& disc_colour, const Bgr* plate) {
  Bgr median = median_of_ring(ring);
  if (plate == nullptr) return median;
  const float near2 = kSameColour2 * (disc_colour - median).squaredNorm();
  Bgr mean;
  if ((median - *plate).squaredNorm() < near2 &&
      samples_near(ring, median, near2, mean) >= kRingSamples / 2) {
    return median;
  }
  return samples_near(ring, *plate, near2, mean) >= kLeastOfPlate ? mean : median;
}

Bgr share_function(const Ring& ring, const Bgr& surroundings, const Bgr& difference) {
  const float contrast2 = difference.squaredNorm();
  Bgr other = Bgr::Zero();
  int count = 0;
  for (int i = 0; i < kRingSamples; ++i) {
    const Bgr value = Bgr(ring[0][i], ring[1][i], ring[2][i]) - surroundings;
    const float along = difference.dot(value);
    const float off_line2 = value.squaredNorm() - along * along / contrast2;
    if (std::abs(along) < kLeastSecondShare * contrast2 || off_line2 > kForeign2 * contrast2)
      continue;
    other += along > 0.0F ? value : Bgr(-value);
    ++count;
  }
  Bgr direction = difference;
  if (count >= kLeastSecondSamples) {
    direction -= other * (difference.dot(other) / other.squaredNorm());
    if (direction.squaredNorm() < kLeastTurnedContrast2 * contrast2) direction = difference;
  }
  return direction / direction.dot(difference);
}

}  // namespace nadir::vision
