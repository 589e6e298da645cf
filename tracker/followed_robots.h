#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "calibration/plane_map.h"
#include "fusion/planar_pose.h"
#include "tracker/alignment/pose_aligner.h"
#include "vision/frame.h"
#include "vision/marker_layout.h"
#include "vision/marker_observation.h"
#include "vision/prefetch.h"
#include "vision/sparse_search.h"

namespace nadir::tracker {

/// A robot that was seen in the frame before, and how it is expected in the next.
struct FollowedRobot {
  std::size_t layout = 0;
  int team = 0;
  int identity = -1;  ///< index into MarkerLayout::identities, -1 for an anonymous robot
  fusion::PlanarPose pose;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< of x, y, heading; per second
  vision::CaptureTime last_seen{};
  int sightings = 0;  ///< in a row, read the same way
  int missed = 0;     ///< frames since then
  ExpectedLook look;
  AlignedPose aligned;                   ///< in this frame, if `found`
  vision::RobotObservation observation;  ///< the same in the detector's words
  bool found = false;                    ///< in this frame, by alignment
  bool continued = false;                ///< in this frame, by alignment or detection
};

/// The robots of one camera that are followed from frame to frame without being detected again:
/// predict, align, verify. Only what the detector read the same way three times in a row is
/// followed; whoever does not look as before must be detected again, and for half a second is
/// looked for where it was.
class FollowedRobots {
 public:
  /// `maps`: of the planes of the layouts' marks.
  FollowedRobots(const std::vector<vision::MarkerLayout>& layouts,
                 const std::vector<calibration::PlaneMap>& maps, int width_px, int height_px,
                 const AlignmentSettings& settings = {});

  /// Nothing: the mosaic is recognised by the frames' noise.
  void set_mosaic(std::optional<Mosaic> mosaic) { stated_mosaic_ = mosaic; }

  /// Aligns all robots that are followed with a new frame. A capture time before the last one, or
  /// long after it, lets all of them go.
  void follow(const vision::Frame& frame);
  /// Robots; those with `found` were aligned with this frame.
  std::span<const FollowedRobot> robots() const { return robots_; }
  /// True where nothing is known of the frame, or a robot was missed in the one before: then all of
  /// it must be searched.
  bool needs_full_search() const { return needs_full_search_; }
  /// A robot cannot have driven further since the frame before, wherever in the picture it is.
  int farthest_since_last_frame_px(std::size_t layout) const;
  /// Appends the rows in which the detector is to look for robots of a layout that were lost or are
  /// too new to be followed.
  void append_regions(std::size_t layout, std::vector<vision::RowBand>& bands) const;
  /// True if a robot that was there in the frame before is neither aligned nor among those that the
  /// detector saw where it was looked for: it may be anywhere.
  bool misses_someone(std::size_t layout, std::span<const vision::RobotObservation> seen);

  /// Aligns a robot that was detected in this frame at a pose. False where alignment does not agree
  /// with the detector: then what the detector measured is all that is known.
  bool refine(const vision::Frame& frame, std::size_t layout,
              const vision::RobotObservation& observation, const fusion::PlanarPose& detected,
              const vision::PixelPoint& centre_px, double deviation_px, AlignedPose& result);

  /// Remembers a robot that is reported in this frame under its own number.
  void remember_aligned(std::size_t index, vision::CaptureTime now);
  void remember_detected(std::size_t layout, const vision::RobotObservation& observation,
                         const fusion::PlanarPose& pose, const AlignedPose* aligned,
                         vision::CaptureTime now);
  /// After all were remembered: lets go of those that have not been seen for long.
  void end_frame();

  const SensorModel& sensor() const { return sensor_; }

 private:
  void look_for_mosaic(const cv::Mat& image);
  vision::PixelPoint expected_px(const FollowedRobot& robot) const;
  double search_radius_px(const FollowedRobot& robot) const;
  PoseGuess predict(const FollowedRobot& robot, vision::CaptureTime now) const;
  vision::PixelFetch pixels_of(const cv::Mat& image, const FollowedRobot& robot) const;
  void align(const vision::Frame& frame, FollowedRobot& robot);
  void observe(FollowedRobot& robot) const;
  void teach(const cv::Mat& image, std::size_t layout);
  void list_obstacles(std::size_t layout, const Eigen::Vector2d& except_m);

  std::vector<vision::MarkerLayout> layouts_;
  std::vector<std::unique_ptr<PlaneGrid>> grids_;
  std::vector<PoseAligner> aligners_;
  SensorModel sensor_;
  std::optional<Mosaic> stated_mosaic_;
  Mosaic mosaic_ = Mosaic::kNone;
  unsigned frames_ = 0;
  unsigned aligned_in_frame_ = 0;
  vision::CaptureTime last_frame_{};
  double gap_s_ = 0.0;  ///< between the last two frames
  int full_searches_due_ = 1;
  bool needs_full_search_ = true;
  std::vector<FollowedRobot> robots_;
  std::vector<Obstacle> obstacles_;
};

}  // namespace nadir::tracker
