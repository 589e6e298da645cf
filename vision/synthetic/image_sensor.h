#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/synthetic/random_stream.h"
#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// Turns light on the pixels into a digital picture: colour mosaic, shot and read noise in
/// electrons, full well, gamma, 8 bits, and the mosaic's bilinear interpolation, which keeps the
/// native samples as they are.
class ImageSensor {
 public:
  explicit ImageSensor(const SceneSensor& sensor);

  /// Light without noise to digital samples of one row.
  /// `light`: 3 * `width` linear grey levels, blue green red; `samples`: with a mosaic `width`
  /// bytes, else 3 * `width`.
  void expose_row(const float* light, int width, int row, RandomStream& random,
                  std::uint8_t* samples);
  bool has_mosaic() const { return sensor_.mosaic != SceneSensor::Mosaic::kNone; }
  /// Channel (0 blue, 1 green, 2 red) that a pixel of the mosaic measures.
  int native_channel(int u, int v) const { return pattern_[(v & 1) * 2 + (u & 1)]; }
  /// Bilinear colours of a mosaic. `bgr` gets its size.
  void demosaic(const cv::Mat& samples, cv::Mat& bgr) const;

 private:
  void add_noise(int count, RandomStream& random);
  void quantise(int count, std::uint8_t* samples) const;

  SceneSensor sensor_;
  std::array<int, 4> pattern_{};
  std::vector<std::uint8_t> gamma_table_;  ///< of 1/257 grey levels; empty with gamma 1
  std::vector<float> row_;
};

}  // namespace nadir::vision
