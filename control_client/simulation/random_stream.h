#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace nadir::control_client {

/// What a stream of a run is for. Streams of one run do not depend on each other, so switching one
/// effect off leaves the others as they were.
enum class RandomPurpose : std::uint64_t {
  kWheelNoise = 1,
  kVision = 2,
  kSlip = 3,
  kPixelCounts = 4,
  kBurstLoss = 5,
  kLandmarks = 6,
  kGyro = 7,
  kMagnetometer = 8,
  kHeading = 9,
};

/// Random numbers that are the same on every machine (SplitMix64; Steele, Lea, Flood 2014).
class RandomStream {
 public:
  RandomStream(std::uint64_t run_seed, RandomPurpose purpose)
      : state_(run_seed * 1000003ULL + static_cast<std::uint64_t>(purpose)) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box and Muller, cosine branch only).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace nadir::control_client
