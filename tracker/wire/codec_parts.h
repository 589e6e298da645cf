#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

// What the codecs of all streams share.

/// False if the text is too long for the field or holds a zero byte.
template <std::size_t N>
bool encode_text(const std::string& text, char (&field)[N]) {
  if (text.size() >= N || text.find('\0') != std::string::npos) return false;
  std::memcpy(field, text.c_str(), text.size() + 1);
  return true;
}

inline bool all_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

inline bool is_within(double number, double limit) { return std::abs(number) <= limit; }

/// x m, y m, heading rad: finite, and the heading in (-pi, pi].
inline bool is_sound_pose(std::span<const double, 3> pose) {
  return all_finite(pose) && fusion::wrap_angle(pose[2]) == pose[2];
}

/// Row-major, order x y heading: finite, no variance negative.
inline bool is_sound_covariance(std::span<const double, 9> covariance) {
  return all_finite(covariance) && covariance[0] >= 0.0 && covariance[4] >= 0.0 &&
         covariance[8] >= 0.0;
}

inline void encode_pose(const fusion::PlanarPose& pose, double (&field)[3]) {
  field[0] = pose.x_m;
  field[1] = pose.y_m;
  field[2] = pose.heading_rad;
}

inline fusion::PlanarPose decode_pose(const double (&field)[3]) {
  return {field[0], field[1], field[2]};
}

inline void encode_covariance(const fusion::PoseCovariance& covariance, double (&field)[9]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) field[3 * row + column] = covariance(row, column);
  }
}

inline void decode_covariance(const double (&field)[9], fusion::PoseCovariance* covariance) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) (*covariance)(row, column) = field[3 * row + column];
  }
}

}  // namespace nadir::tracker
