#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "fusion/planar_pose.h"
#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/plane_grid.h"
#include "tracker/alignment/sensor_model.h"
#include "vision/prefetch.h"
#include "vision/tag_layout.h"

namespace nadir::tracker {

/// A tag's pose, estimated from the pixels themselves.
struct AlignedTag {
  fusion::PlanarPose pose_world_tag;  ///< its middle and x axis
  /// Inverse of the Fisher information, inflated where residuals are larger than noise, and a
  /// floor. Without the calibration's part.
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  double contrast = 0.0;   ///< white minus black, grey levels, mean of the channels
  double explained = 0.0;  ///< share of the pixels' variance that the print explains, at most 1
  double chi_square_per_dof = 0.0;
  int iterations = 0;
};

/// Settings that are the same for every camera and every light.
struct TagAlignmentSettings {
  double huber_sigmas = 2.5;
  double floor_px = 0.0001;  ///< of the middle, per axis: what neither noise nor residuals tell of
  double floor_cells = 0.0;  ///< the same in cells: how well tags are printed and cut, one may say
  double margin_sigmas = 2.3;  ///< of the blur; what lies beyond the print is not known
  /// Below it, it is another tag, one that is covered in part, or none.
  double least_explained = 0.85;
};

/// Estimates poses of one layout's tags by aligning their blurred print with the frame:
/// Gauss-Newton on the photometric residual
///
///     value(pixel) - black - (white - black) share of white(pixel; pose)
///
/// over x, y and heading on the plane; black and white, free for each channel, are eliminated by
/// the Schur complement. Weights are those of the noise, with Huber's limit. Not thread-safe.
class TagAligner {
 public:
  /// `grid` must outlive the aligner and belong to the plane of the tags.
  TagAligner(const vision::TagLayout& layout, const PlaneGrid& grid,
             const TagAlignmentSettings& settings = {});
  ~TagAligner();
  TagAligner(TagAligner&&) noexcept;
  TagAligner& operator=(TagAligner&&) noexcept;

  /// Pixels that the next call of `align` asks memory for, between those that it gathers: the tag
  /// that is next.
  void fetch_meanwhile(const vision::PixelFetch& next);

  /// `guess`: of the tag, good to half a cell and about 5 degrees; `middle_px`: where the image
  /// shows it, to a few pixels. False where no pose can be had: partly out of the image, no
  /// convergence near the guess, or this print is not there.
  bool align(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor, int tag_id,
             const fusion::PlanarPose& guess, const vision::PixelPoint& middle_px,
             AlignedTag& result);

  /// Tells the camera's model what the last aligned tag's pixels say of noise and blur.
  void teach(SensorModel& sensor);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::tracker
