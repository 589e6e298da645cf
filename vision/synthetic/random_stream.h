#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace nadir::vision {

/// Random numbers that are the same on every machine (SplitMix64; Steele, Lea, Flood 2014).
/// A stream is named by numbers (seed, frame, purpose), so any frame can be made without those
/// before it.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t frame = 0, std::uint64_t purpose = 0)
      : state_(scrambled(seed + scrambled(frame + scrambled(purpose + 0x9E3779B97F4A7C15ULL)))) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    return scrambled(state_);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In 0 to count - 1.
  std::uint64_t below(std::uint64_t count) { return next() % count; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  static std::uint64_t scrambled(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace nadir::vision
