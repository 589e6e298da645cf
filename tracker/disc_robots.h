#pragma once

#include <span>
#include <vector>

#include "tracker/followed_robots.h"
#include "tracker/pipeline_setup.h"
#include "tracker/pose_from_markers.h"
#include "tracker/pose_report.h"
#include "vision/disc_pattern_detector.h"
#include "vision/frame.h"

namespace nadir::tracker {

/// A robot whose discs are in a frame. `observation` lives until the next frame.
struct DiscRobot {
  std::size_t layout_index = 0;
  const vision::RobotObservation* observation = nullptr;
  MarkerPose pose;
  int followed = -1;  ///< index of the robot that is followed
  int refined = -1;   ///< index of the alignment of a robot that was detected
  bool shares_disc = false;

  bool aligned() const { return followed >= 0 || refined >= 0; }
};

/// Sees the robots with discs of one camera: aligns those that are followed, searches for others
/// with a detector for each layout, makes poses and covariances of both. Poses come from the frame
/// alone. Not thread-safe.
class DiscRobots {
 public:
  /// For frames of this size. `setup` and `maps` (of each layout) must outlive it; of the layouts
  /// those without tags come first. Throws InputError if discs are too small to be seen.
  DiscRobots(const PipelineSetup& setup, const std::vector<calibration::PlaneMap>& maps,
             int width_px, int height_px);

  /// Finds robots in the frame.
  void detect(const vision::Frame& frame);
  /// Their poses. What is no robot goes to `rejected`.
  void locate(const vision::Frame& frame, std::vector<RejectionReport>& rejected);
  /// Of the last frame; valid until the next.
  std::span<const DiscRobot> robots() const { return robots_; }

  /// A robot was reported under this number. Followed is only who has the number that is read from
  /// it.
  void remember(const DiscRobot& robot, int id, vision::CaptureTime capture_time);
  /// After all were remembered: lets go of the others, and tells what the detectors rejected.
  void end_frame(FrameReport& report);

 private:
  // One layout's detector and what it saw in this frame.
  struct Eye {
    vision::DiscPatternDetector detector;
    vision::DetectionResult seen;
  };

  void search(const vision::Frame& frame);
  void search_parts(const vision::Frame& frame);
  void search_everywhere(const vision::Frame& frame);
  bool misses_someone();
  void look(std::size_t eye, const vision::Frame& frame);
  void locate_followed(std::vector<RejectionReport>& rejected);
  void locate_detected(const vision::Frame& frame, std::vector<RejectionReport>& rejected);
  void refine(const vision::Frame& frame, DiscRobot& robot);
  bool take_alignment(const AlignedPose& aligned, DiscRobot& robot) const;
  bool measure(DiscRobot& robot) const;
  void settle_shared_discs(std::vector<RejectionReport>& rejected);

  const PipelineSetup& setup_;
  const std::vector<calibration::PlaneMap>& maps_;
  int height_px_;
  std::vector<Eye> eyes_;
  FollowedRobots followed_;
  int slice_ = 0;  // of the picture, to be searched next
  std::vector<vision::RowBand> bands_;
  std::vector<vision::PixelPoint> known_;
  std::vector<AlignedPose> refined_;
  std::vector<DiscRobot> robots_;
};

}  // namespace nadir::tracker
