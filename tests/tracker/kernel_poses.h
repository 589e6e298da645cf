#pragma once

#include <array>
#include <vector>

#include "tests/tracker/synthetic_setup.h"

/// Poses (x m, y m, heading rad) by the alignment that a program is linked with, as it is built,
/// and by a plain build of the same sources: no vectors, no clones for wide registers, no
/// optimisation of loops. kernel_poses.cpp is compiled once for each.
namespace nadir::kernels {

/// What one robot's alignment starts with: `id` of a tag, or of a robot with discs.
struct Guess {
  int id = 0;
  std::array<double, 3> pose{};
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();
};

struct Picture {
  cv::Mat image;
  std::vector<Guess> guesses;
};

using Poses = std::vector<std::array<double, 3>>;

/// One pose for each guess, blur and noise are learnt on the way; NaN where none was found.
/// `mosaic`: RGGB, or none.
Poses usual_poses(const vision::MarkerLayout& layout, const calibration::PlaneMap& map, bool mosaic,
                  const std::vector<Picture>& pictures);
Poses plain_poses(const vision::MarkerLayout& layout, const calibration::PlaneMap& map, bool mosaic,
                  const std::vector<Picture>& pictures);

}  // namespace nadir::kernels
