#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "vision/pixel.h"
#include "vision/synthetic/renderer.h"

namespace nadir::vision {

/// A surveyed point of a plane and where the camera sees it.
struct CalibrationPoint {
  PixelPoint pixel;
  Eigen::Vector2d world_m;
};

/// The scene's grid of points over the whole image, with its declared noise.
std::vector<CalibrationPoint> calibration_points(const Scene& scene, const CameraModel& camera,
                                                 std::uint64_t seed);

/// How pictures are kept.
enum class PictureFormat {
  kPng,   ///< exact
  kJpeg,  ///< quality 95: a fifth of the size, and what many cameras deliver
};

/// Writes `frames` frames into a folder: frames/000000.png ..., times.csv (here and beside the
/// pictures), truth.jsonl, points.csv. Throws std::runtime_error if a file cannot be written.
/// `progress` is told the frames done.
void write_recording(Renderer& renderer, std::uint64_t seed, std::uint64_t frames,
                     const std::filesystem::path& folder,
                     const std::function<void(std::uint64_t)>& progress,
                     PictureFormat format = PictureFormat::kPng);

}  // namespace nadir::vision
