#pragma once

#include <optional>
#include <vector>

#include "tracker/disc_robots.h"
#include "tracker/pipeline_setup.h"
#include "tracker/pose_report.h"
#include "tracker/robot_tracks.h"
#include "tracker/tag_robots.h"
#include "vision/frame.h"

namespace nadir::tracker {

/// The story of a frame: find each robot's markers, map pixels to metres, attach a covariance, say
/// who is who, report. A pose is what its frame says: of other frames it takes only where to look
/// and who is who. Not thread-safe: one for each camera.
class CameraPipeline {
 public:
  /// For frames of this size. Throws InputError if it is not the calibration's, if a team's name is
  /// in two layouts, or if a layout's markers are too small to be seen.
  CameraPipeline(PipelineSetup setup, int width_px, int height_px);
  CameraPipeline(const CameraPipeline&) = delete;
  CameraPipeline& operator=(const CameraPipeline&) = delete;

  /// Fills `report` (what it held before does not matter). `read_us` is the time that reading the
  /// frame took. Throws InputError if the frame is not of the pipeline's size. Allocates nothing
  /// once its lists have grown.
  void process(const vision::Frame& frame, double read_us, FrameReport& report);

  const PipelineSetup& setup() const { return setup_; }

 private:
  void check_size(const vision::Frame& frame) const;
  void identify(vision::CaptureTime capture_time, FrameReport& report);
  void list_candidates();
  void report_robot(std::size_t candidate, int id, vision::CaptureTime capture_time,
                    FrameReport& report);

  PipelineSetup setup_;
  int width_px_;
  int height_px_;
  std::vector<calibration::PlaneMap> maps_;  // of each layout
  std::vector<int> first_kind_;              // of each layout's teams, for RobotTracks
  DiscRobots discs_;
  std::optional<TagRobots> tags_;  // where a layout has them
  RobotTracks tracks_;
  std::vector<TrackCandidate> candidates_;  // robots with discs, then those with tags
};

}  // namespace nadir::tracker
