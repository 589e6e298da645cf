#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

#include "fusion/planar_pose.h"
#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/plane_grid.h"
#include "vision/prefetch.h"

namespace nadir::tracker {

inline constexpr int kTagPatchCapacity = 8192;  ///< values of a tag that are looked at, at most

/// The pixels of one tag as flat lists that loops run over eight at a time. A pixel with three
/// measured channels counts once, with their sum: prints are black and white, so that says as much
/// as each of them. With a mosaic every pixel has the one value that it measured, and the channels
/// come one after the other, as they have levels of their own. Segments are padded with places that
/// are far away.
struct TagPatch {
  int segments = 0;  ///< 1, or 3 with a mosaic
  std::array<int, 3> begin{};
  std::array<int, 3> end{};  ///< multiples of eight apart
  /// Of the pixels on the plane, metres, counted from the tag's expected middle.
  alignas(32) std::array<float, kTagPatchCapacity> x_m;
  alignas(32) std::array<float, kTagPatchCapacity> y_m;
  alignas(32) std::array<float, kTagPatchCapacity> value;
};

/// Gathers the pixels of `image` (CV_8UC3 or CV_8UC1) in a square about `pose` on the plane, whose
/// half side is `reach_m`; every second or third row only, if they are too many. `middle_px` is
/// where the image shows its middle, about. `meanwhile`: of another place, fetched between the
/// rows. False if fewer than half of the pixels are in the image.
bool gather_tag(const cv::Mat& image, Mosaic mosaic, const PlaneGrid& grid,
                const fusion::PlanarPose& pose, const vision::PixelPoint& middle_px, double reach_m,
                vision::PixelFetch& meanwhile, TagPatch& patch);

}  // namespace nadir::tracker
