#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <span>

#include "tracker/alignment/aligned_pose.h"
#include "tracker/alignment/disc_template.h"
#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/plane_grid.h"
#include "tracker/alignment/sensor_model.h"
#include "vision/prefetch.h"

namespace nadir::tracker {

class RobotFit;

/// Estimates poses of one layout's robots by aligning the template of their discs with the frame:
/// Gauss-Newton on the photometric residual
///
///     value(pixel, channel) - level(disc, channel) - contrast(disc, channel) share(pixel; pose)
///
/// over x, y and heading. The levels and contrasts, free for each disc and channel, are eliminated
/// by the Schur complement: each disc gives information and gradient for the place of its own
/// centre, and the rigid pattern of the layout joins them, as rigid_fit does with measured centres.
/// Pixels are weighted with their noise, Huber's weights limit what does not belong there, and a
/// disc whose residuals are larger than noise (a shadow's edge) counts accordingly less. Pixels
/// further from an edge than AlignmentSettings::margin_sigmas blurs have no part in it: they say
/// nothing of a disc's place.
///
/// Another kind of template (a tag's cells) is another function for shares and their derivatives.
/// Allocates nothing after construction. Not thread-safe: one per thread.
class PoseAligner {
 public:
  /// `grid` must outlive the aligner and belong to the plane of the layout's marks.
  PoseAligner(const vision::MarkerLayout& layout, const PlaneGrid& grid,
              const AlignmentSettings& settings = {});
  ~PoseAligner();
  PoseAligner(PoseAligner&&) noexcept;
  PoseAligner& operator=(PoseAligner&&) noexcept;

  /// Pixels that the next call of `align` asks memory for, between those that it gathers: the robot
  /// that is next.
  void fetch_meanwhile(const vision::PixelFetch& next);

  /// False, and nothing of use in `result`, where no pose can be had: outside of the image, fewer
  /// than two discs that look as expected, or no convergence. `look` null: nothing is known of the
  /// colours. `obstacles`: other robots (their plates), in the same plane.
  bool align(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor, const PoseGuess& guess,
             const ExpectedLook* look, std::span<const Obstacle> obstacles, AlignedPose& result);

  /// Tells the camera's model what the pixels of one disc of the last aligned robot say of it. To
  /// be given the same frame, once. `lesson` counts the lessons of this robot: its discs take
  /// turns.
  void teach(const cv::Mat& image, Mosaic mosaic, unsigned lesson, SensorModel& sensor);

  const DiscTemplate& robot() const;

 private:
  AlignmentSettings settings_;
  std::unique_ptr<RobotFit> fit_;
  vision::PixelFetch meanwhile_;
};

}  // namespace nadir::tracker
