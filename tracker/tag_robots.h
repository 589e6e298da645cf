#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "calibration/plane_map.h"
#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/plane_grid.h"
#include "tracker/alignment/sensor_model.h"
#include "tracker/alignment/tag_aligner.h"
#include "tracker/pose_from_markers.h"
#include "tracker/pose_report.h"
#include "tracker/tag_pose.h"
#include "vision/frame.h"
#include "vision/prefetch.h"
#include "vision/tag_search.h"

namespace nadir::tracker {

/// One layout of robots with tags.
struct TagRobotKind {
  vision::TagLayout layout;
  calibration::PlaneMap map;     ///< of the plane of the tags
  std::size_t layout_index = 0;  ///< in the pipeline's setup
};

/// A robot that a frame shows by one or more of its tags.
struct TagRobot {
  std::size_t layout_index = 0;
  int id = 0;
  MarkerPose pose;
  std::array<int, vision::kMaxDiscs> pixels{};  ///< of each tag's square
  int tag_count = 0;                            ///< entries of `pixels` that count
  double confidence = 0.0;
  bool aligned = true;  ///< all tags that count, with the pixels
};

/// How the tags of a camera become poses.
struct TagSettings {
  /// Poses from the pixels themselves; false: from the corners as they are detected.
  bool aligned = true;
  std::optional<Mosaic> mosaic = {};  ///< of the sensor; nothing: recognised by the noise
  TagAlignmentSettings alignment = {};
};

/// Sees the robots with tags of one camera, and remembers where they were and how they moved: so
/// that their tags are aligned there, or looked for there first. Poses come from the frame alone.
/// Not thread-safe.
class TagRobots {
 public:
  /// For frames of this size. `kinds`: at least one. Throws InputError if tags are too small to be
  /// seen.
  TagRobots(std::vector<TagRobotKind> kinds, int width_px, int height_px,
            const TagSettings& settings = {});

  /// Finds tags in the frame: aligns those of robots that are followed, searches for others.
  void detect(const vision::Frame& frame);
  /// Their robots' poses. Tags that speak against each other of one robot give several robots of
  /// one number, the one with more and surer tags first. What is no robot goes to `rejected`.
  void locate(std::vector<RejectionReport>& rejected);

  /// Of the last frame; valid until the next.
  std::span<const TagRobot> robots() const { return robots_; }
  /// Tags of the last frame that were aligned where they were expected, without a detector.
  std::size_t followed() const { return found_.size(); }

 private:
  // A robot as it was seen last.
  struct Memory {
    std::size_t kind = 0;
    int id = 0;
    std::vector<vision::MountedTag> tags;
    fusion::PlanarPose pose;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, m/s, rad/s
    bool has_velocity = false;
    vision::PixelPoint centre_px = vision::PixelPoint::Zero();
    vision::CaptureTime time{};
    int missed = 0;  // frames since then
  };
  // A tag of this frame, before robots are made of them.
  struct Sighting {
    std::size_t kind = 0;
    int robot_id = 0;
    int tag_id = 0;
    TagPose pose;
    int pixels = 0;
    double confidence = 0.0;
    bool aligned = false;
    bool taken = false;
  };

  void look_for_mosaic(const cv::Mat& image);
  vision::PixelFetch pixels_of(const cv::Mat& image, const Memory& robot) const;
  void expect(const vision::Frame& frame, const Memory& robot, const Memory* next);
  bool align(const cv::Mat& image, Sighting& sighting, bool teach);
  void take(const cv::Mat& image, const vision::TagSighting& seen);
  TagRobot robot_of(std::size_t first);
  void remember();

  std::vector<TagRobotKind> kinds_;
  TagSettings settings_;
  vision::TagSearch search_;
  std::vector<std::unique_ptr<PlaneGrid>> grids_;  // of each kind
  std::vector<TagAligner> aligners_;               // of each kind
  SensorModel sensor_;
  Mosaic mosaic_ = Mosaic::kNone;
  unsigned frames_ = 0;
  vision::CaptureTime time_{};
  std::vector<Memory> memories_;
  std::vector<vision::ExpectedTag> expected_;
  std::vector<cv::Rect> found_;
  vision::TagSearchResult seen_;
  std::vector<RejectionReport> misshapen_;
  std::vector<Sighting> sightings_;
  std::vector<TagPose> fused_;
  std::vector<TagRobot> robots_;
};

}  // namespace nadir::tracker
