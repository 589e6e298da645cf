#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_file.h"
#include "calibration/pixel_count_variance.h"
#include "tracker/followed_robots.h"
#include "tracker/pose_from_markers.h"
#include "tracker/pose_report.h"
#include "tracker/robot_tracks.h"
#include "tracker/tag_robots.h"
#include "vision/colour_classes.h"
#include "vision/disc_pattern_detector.h"
#include "vision/frame.h"
#include "vision/marker_layout.h"

namespace nadir::tracker {

/// What poses and covariances are made of.
enum class PoseSource {
  kAlignment,         ///< pixels aligned with the layout's template; covariance of Fisher
  kAlignedAndCounts,  ///< the same poses with covariances from the discs' pixel counts
  kDetector,          ///< discs as the detector measures them, covariances from `variance`
};

/// Everything that makes poses of one camera's frames.
struct PipelineSetup {
  std::string camera;  ///< its name
  calibration::Calibration calibration;
  std::filesystem::path calibration_file;     ///< for messages
  std::vector<vision::MarkerLayout> layouts;  ///< at least one, with different team names
  vision::ColourClasses colours = vision::default_colour_classes();
  /// Of the discs' centres; by default from their own pixels.
  calibration::PixelCountVariance variance = {};
  TrackSettings tracks = {};
  PoseSource source = PoseSource::kAlignment;
  std::optional<Mosaic> mosaic = {};  ///< of the sensor; nothing: recognised by the noise
  /// Error of an aligned mark, per axis, that neither noise nor residuals tell of; nothing: as
  /// small as the synthetic camera shows it.
  std::optional<double> alignment_floor_px = {};
};

/// The story of a frame: align the robots that are followed, search for others (one detector for
/// each layout), plane map, variance, identity, report. A pose is what its frame says: of other
/// frames it takes only where to look and who is who. Not thread-safe: one for each camera.
class CameraPipeline {
 public:
  /// For frames of this size. Throws InputError if it is not the calibration's, if a team's name is
  /// in two layouts, or if a layout's discs are too small to be seen.
  CameraPipeline(PipelineSetup setup, int width_px, int height_px);

  /// Fills `report` (what it held before does not matter). `read_us` is the time that reading the
  /// frame took. Throws InputError if the frame is not of the pipeline's size. Allocates nothing
  /// once its lists have grown.
  void process(const vision::Frame& frame, double read_us, FrameReport& report);

  const PipelineSetup& setup() const { return setup_; }

 private:
  // One layout's detector and what it saw in this frame.
  struct Eye {
    vision::DiscPatternDetector detector;
    vision::DetectionResult seen;
    int first_kind = 0;  // of the layout's teams, for RobotTracks
  };
  // A robot in this frame; the observation lives in its eye or with the robot that is followed.
  struct Sighting {
    std::size_t layout = 0;
    const vision::RobotObservation* observation = nullptr;
    MarkerPose pose;
    bool shares_disc = false;
    int followed = -1;  // index of the robot that is followed
    int aligned = -1;   // of a detected robot, index into refined_
  };

  void make_tags(int first_kind);
  void check_size(const vision::Frame& frame) const;
  void search(const vision::Frame& frame);
  void locate_followed(FrameReport& report);
  void locate_detected(const vision::Frame& frame, FrameReport& report);
  void refine(const vision::Frame& frame, Sighting& sighting);
  bool take_alignment(const AlignedPose& aligned, const vision::RobotObservation& robot,
                      std::size_t layout, MarkerPose& pose) const;
  bool measure_discs(const vision::RobotObservation& robot, const calibration::PlaneMap& map,
                     DiscCovariances& covariances_m2) const;
  void settle_shared_discs(FrameReport& report);
  void identify(vision::CaptureTime capture_time, FrameReport& report);
  void remember(const Sighting& sighting, int id, vision::CaptureTime capture_time);
  void report_rejected(FrameReport& report) const;
  RobotReport robot_report(const Sighting& sighting, int id) const;

  // Of the plane of a layout's markers.
  const calibration::PlaneMap& map(std::size_t layout) const { return maps_[layout]; }

  PipelineSetup setup_;
  int width_px_;
  int height_px_;
  std::vector<calibration::PlaneMap> maps_;  // of each layout
  std::vector<Eye> eyes_;
  FollowedRobots followed_;
  std::optional<TagRobots> tags_;  // where a layout has them
  int tag_kind_ = 0;               // of a layout with tags, for RobotTracks: this and its index
  int slice_ = 0;                  // of the picture, to be searched next
  RobotTracks tracks_;
  std::vector<vision::PixelPoint> known_;
  std::vector<AlignedPose> refined_;
  std::vector<Sighting> sightings_;
  std::vector<TrackCandidate> candidates_;
};

}  // namespace nadir::tracker
