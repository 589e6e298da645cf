#pragma once

#include <cstdint>
#include <cstring>

/// Eight numbers at once in the compiler's portable vectors: one register with AVX2, two with SSE
/// or NEON. Vectors cross functions by reference only, and only where these are inlined: they have
/// another form in each clone of NADIR_VECTOR_CLONES.
namespace nadir::tracker::lanes {

#ifndef NADIR_LANES
#define NADIR_LANES 8
#endif
inline constexpr int kLanes = NADIR_LANES;  ///< 1 in a plain build, for comparison
// NOLINTBEGIN(modernize-use-using)
typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t Ints __attribute__((vector_size(4 * kLanes)));
// NOLINTEND(modernize-use-using)

#define NADIR_INLINE inline __attribute__((always_inline))

NADIR_INLINE void load(const float* from, Floats& to) { std::memcpy(&to, from, sizeof(to)); }
NADIR_INLINE void store(const Floats& from, float* to) { std::memcpy(to, &from, sizeof(from)); }

NADIR_INLINE float sum_of(const Floats& values) {
#if NADIR_LANES == 8
  const Floats four = values + __builtin_shufflevector(values, values, 4, 5, 6, 7, 0, 1, 2, 3);
  const Floats two = four + __builtin_shufflevector(four, four, 2, 3, 0, 1, 6, 7, 4, 5);
  return two[0] + two[1];
#else
  float sum = 0.0F;
  for (int i = 0; i < kLanes; ++i) sum += values[i];
  return sum;
#endif
}

/// 1 / sqrt(x) for x > 0: a first guess from the number's bits, then Newton's steps. Three of them
/// for 2e-7, two for 5e-6.
template <int kSteps = 3>
NADIR_INLINE void inverse_root(const Floats& x, Floats& root) {
  root = reinterpret_cast<Floats>(0x5f3759df - (reinterpret_cast<Ints>(x) >> 1));
  const Floats half = 0.5F * x;
  for (int step = 0; step < kSteps; ++step) root = root * (1.5F - half * root * root);
}

/// exp(-x) for 0 <= x <= 80 to 3e-7, relative; smaller than e-80 counts as that.
NADIR_INLINE void exp_of_minus(const Floats& x, Floats& result) {
  constexpr float kLog2e = 1.44269504F;
  Floats power = x * -kLog2e;
  power = power > -115.0F ? power : power * 0.0F - 115.0F;
  const Ints whole = __builtin_convertvector(power, Ints);  // towards zero
  // 2^rest about the middle of (-1, 0]: 2^-0.5 e^y
  const Floats y = (power - __builtin_convertvector(whole, Floats) + 0.5F) * 0.69314718F;
  Floats series = y * (1.0F / 720.0F) + 1.0F / 120.0F;
  series = series * y + 1.0F / 24.0F;
  series = series * y + 1.0F / 6.0F;
  series = series * y + 0.5F;
  series = series * y + 1.0F;
  series = series * y + 1.0F;
  const Ints exponent = (whole + 127) << 23;
  result = 0.70710678F * series * reinterpret_cast<Floats>(exponent);
}

/// The normal distribution: density phi(z) and share below z, Phi(z), to 2e-7 (Abramowitz and
/// Stegun, Handbook of Mathematical Functions, 7.1.26).
NADIR_INLINE void normal(const Floats& z, Floats& density, Floats& below) {
  const Floats away = z < 0.0F ? -z : z;
  Floats power;
  exp_of_minus(0.5F * away * away, power);
  const Floats t = 1.0F / (1.0F + (0.3275911F * 0.70710678F) * away);
  Floats series = 1.061405429F * t - 1.453152027F;
  series = series * t + 1.421413741F;
  series = series * t - 0.284496736F;
  series = series * t + 0.254829592F;
  const Floats tail = 0.5F * series * t * power;
  density = 0.39894228F * power;
  below = z < 0.0F ? tail : 1.0F - tail;
}

}  // namespace nadir::tracker::lanes
