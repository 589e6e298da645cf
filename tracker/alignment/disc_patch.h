#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/plane_grid.h"
#include "vision/prefetch.h"

namespace nadir::tracker {

inline constexpr int kPatchCapacity = 2048;  ///< pixels of a disc that are looked at, at most

/// The pixels about one disc, as flat lists that loops run over eight at a time. With a mosaic only
/// those values that were measured: then the three channels have pixels of their own, one after the
/// other; without one they share all of them. Segments are padded with pixels that do not count.
struct DiscPatch {
  LocalPlane plane;  ///< about the pixel from which du, dv count
  vision::PixelPoint origin_px = vision::PixelPoint::Zero();  ///< that pixel
  int count = 0;    ///< of all pixels, a multiple of eight
  int skipped = 0;  ///< pixels in the middle of a large disc that were left out
  /// Pixels [begin[c], end[c]) have values of channel c in value[c], at the same places.
  std::array<int, 3> begin{};
  std::array<int, 3> end{};
  alignas(32) std::array<float, kPatchCapacity> du;
  alignas(32) std::array<float, kPatchCapacity> dv;
  alignas(32) std::array<float, kPatchCapacity> use;  ///< 1, or 0: does not count
  alignas(32) std::array<std::array<float, kPatchCapacity>, 3> value;
};

/// Which pixels are gathered.
struct PatchWindow {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< of the disc
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();
  double radius_m = 0.0;
  double margin_px = 0.0;  ///< about the edge
  bool whole = false;      ///< all of the disc, not only what is near its edge
  /// Relative change of the light per pixel, to be taken out of the values.
  Eigen::Vector2d light_slope_per_px = Eigen::Vector2d::Zero();
  /// Of another place, fetched meanwhile; or null.
  vision::PixelFetch* meanwhile = nullptr;
};

/// Fills the patch with pixels of `image` (CV_8UC3, or with a mosaic CV_8UC1 too) whose middle lies
/// in the window, all with use = 1; discs that do not fit are thinned out by rows. False if none is
/// in the image.
bool gather(const cv::Mat& image, Mosaic mosaic, const PlaneGrid& grid, const PatchWindow& window,
            DiscPatch& patch);

}  // namespace nadir::tracker
