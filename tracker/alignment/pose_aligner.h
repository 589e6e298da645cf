#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>

#include "calibration/noise_file.h"
#include "fusion/planar_pose.h"
#include "tracker/alignment/disc_template.h"
#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/plane_grid.h"
#include "tracker/alignment/sensor_model.h"
#include "vision/pixel.h"

namespace nadir::tracker {

/// A value of each channel, blue green red, grey levels.
using ChannelVector = Eigen::Vector3d;

/// One disc after its robot's pose was aligned.
struct AlignedDisc {
  ChannelVector level = ChannelVector::Zero();     ///< of the plate beside it
  ChannelVector contrast = ChannelVector::Zero();  ///< of the disc, against the plate
  double pixels = 0.0;                             ///< of the image that show it, in shares
  double chi_square_per_dof = 0.0;                 ///< of its pixels' residuals
  bool counts = false;  ///< took part: it is in the image and not covered
};

/// A robot's pose, estimated from the pixels themselves.
struct AlignedPose {
  fusion::PlanarPose pose_world_robot;
  /// Inverse of the Fisher information, inflated where residuals are larger than noise, and a
  /// floor. Without the calibration's part.
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();  ///< image of the robot's origin
  std::array<AlignedDisc, vision::kMaxDiscs> discs;
  int counting_discs = 0;
  int iterations = 0;
  bool uneven_light = false;  ///< on a disc that counts: a shadow's edge
  double misfit = 0.0;  ///< chi-square per degree of freedom of the discs against the rigid pattern
};

/// What a robot is expected to look like when it is followed: contrasts of its discs as they were.
struct ExpectedLook {
  std::array<ChannelVector, vision::kMaxDiscs> contrast;
};

/// A guess of a pose, good to about a disc's radius and 20 degrees.
struct PoseGuess {
  fusion::PlanarPose pose_world_robot;
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();  ///< roughly where the image shows it
};

/// Settings that are the same for every camera and every light.
struct AlignmentSettings {
  double huber_sigmas = 2.5;
  double far_sigmas = 5.0;  ///< a pixel's pull fades beyond it, once the pose is nearly right
  /// Error of a disc's centre, per axis, that neither noise nor residuals tell of.
  double floor_px = calibration::kAlignmentFloor_px;
  double rim_sigmas = 2.0;     ///< pixels nearer to the plate's rim than this many blurs are masked
  double margin_sigmas = 3.0;  ///< pixels are looked at up to this far outside of an edge
  double least_cosine = 0.97;  ///< between the expected and the seen contrast of a disc
  double least_amplitude =
      0.45;  ///< of a disc's contrast over the expected one, to the median disc
};

/// Estimates poses of one layout's robots by aligning the template of their discs with the frame:
/// Gauss-Newton on the photometric residual
///
///     value(pixel, channel) - level(disc, channel) - contrast(disc, channel) share(pixel; pose)
///
/// over x, y and heading. The levels and contrasts, free for each disc and channel, are eliminated
/// by the Schur complement: each disc gives information and gradient for the place of its own
/// centre, and the rigid pattern of the layout joins them, as rigid_fit does with measured centres.
/// Pixels are weighted with their noise, Huber's weights limit what does not belong there, and a
/// disc whose residuals are larger than noise (a shadow's edge) counts accordingly less.
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

  /// False, and nothing of use in `result`, where no pose can be had: outside of the image, fewer
  /// than two discs that look as expected, or no convergence. `look` null: nothing is known of the
  /// colours. `obstacles`: other robots (their plates), in the same plane.
  bool align(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor, const PoseGuess& guess,
             const ExpectedLook* look, std::span<const Obstacle> obstacles, AlignedPose& result);

  /// Tells the camera's model what the last aligned robot's pixels say of it; a disc at a time.
  void teach(SensorModel& sensor);

  const DiscTemplate& robot() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::tracker
