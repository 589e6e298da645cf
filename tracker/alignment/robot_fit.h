#pragma once

#include <array>
#include <vector>

#include "tracker/alignment/robot_view.h"

namespace nadir::tracker {

/// Gauss-Newton of one robot's pose on the residuals of its discs' pixels: gather, evaluate, step.
/// Each disc gives information and gradient for the place of its own centre; the rigid pattern of
/// the layout joins them. Allocates nothing after construction.
class RobotFit {
 public:
  RobotFit(const DiscTemplate& robot, const PlaneGrid& grid, const AlignmentSettings& settings);

  /// Forgets the robot before. `is_near`: the guess is as good as a last step but one.
  void begin(const fusion::PlanarPose& guess, bool is_near);
  /// Gathers the discs' pixels about the present pose; their levels by plain least squares. False
  /// if no disc is in the image.
  bool gather(const FramePixels& frame, const vision::PixelPoint& near_px, double blur_px,
              std::span<const Obstacle> obstacles);
  /// True once the pose has moved away from where pixels were gathered.
  bool must_gather() const;
  /// What the pixels say of the discs' centres, at the present pose.
  void evaluate(const PixelNoise& noise);
  /// Takes discs out that do not look as they did: covered ones. Returns how many.
  int drop_covered(const ExpectedLook& look);
  /// Where residuals are larger than noise: whether neighbouring pixels err together, and whether
  /// the light falls unevenly there.
  void look_at_structure(const FramePixels& frame, const PixelNoise& noise);
  /// One step of the pose, and the levels with it. False if the discs do not determine a pose.
  bool step();
  /// Everything but the robot's centre in the image and the number of iterations.
  void finish(AlignedPose& result) const;

  /// After a step of this length the next is in the noise.
  bool is_near() const;
  /// The step after this one would be smaller than any error.
  bool is_settled() const;
  int counting_discs() const;

  const DiscTemplate& robot() const { return robot_; }
  const RobotPlace& place() const { return place_; }
  const RobotView& view() const { return view_; }
  bool counts(std::size_t disc) const { return counts_[disc]; }
  /// Of a disc's pixels, variance over that of their noise.
  double inflation(std::size_t disc) const { return inflation_[disc]; }
  /// The light across a disc is a shadow's edge, or may be one.
  bool is_uneven(std::size_t disc) const;
  /// Gathers all pixels of a disc at the present pose; its levels stay. False if there is none.
  bool gather_whole(const FramePixels& frame, std::size_t disc);
  DiscState& disc(std::size_t index) { return discs_[index]; }

 private:
  OutlierLimits limits() const;
  Eigen::Vector2d centre_m(std::size_t i) const { return place_.point(robot_.place_m[i]); }
  void set_neighbours(std::size_t i);
  bool is_suspicious(std::size_t i) const;
  void shorten_step();
  Eigen::Matrix2d covariance_m2(std::size_t i, double floor_m2) const;

  DiscTemplate robot_;
  AlignmentSettings settings_;
  RobotView view_;
  std::vector<DiscState> discs_;
  std::array<CentreEvidence, vision::kMaxDiscs> evidence_;
  std::array<double, vision::kMaxDiscs> inflation_{};
  std::array<double, vision::kMaxDiscs> structure_{};
  std::array<double, vision::kMaxDiscs> shading_m2_{};  // variance of a centre by uneven light
  std::array<bool, vision::kMaxDiscs> counts_{};
  std::array<bool, vision::kMaxDiscs> is_whole_{};  // all of a disc's pixels were gathered
  RobotPlace place_;
  RobotPlace gathered_at_;
  double last_step_px_ = 0.0;
  Eigen::Vector3d last_step_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::tracker
