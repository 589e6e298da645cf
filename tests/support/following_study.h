#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracker/camera_pipeline.h"
#include "vision/synthetic/renderer.h"

namespace nadir::support {

/// What happens to the robots of a study.
struct FollowingStory {
  int frames = 100;
  double speed_mps = 1.0;
  bool covers_one_disc = false;   ///< now and then something lies on one disc of a robot
  bool covers_two_discs = false;  ///< or on two
  bool balls = false;             ///< orange balls and coloured clutter beside and on robots
  bool swaps = false;             ///< now and then two robots are carried to each other's place
  bool lifts = false;             ///< now and then robots are taken away and put down elsewhere
  bool crossing = false;  ///< not in pairs: half of them drive closely across the others' ways
  tracker::PoseSource source = tracker::PoseSource::kAlignment;
};

struct FollowingStudy {
  std::uint64_t robot_frames = 0;
  std::uint64_t uncovered = 0;      ///< of them with all discs in sight
  std::uint64_t missed = 0;         ///< of those with all discs in sight
  std::uint64_t wrong_ids = 0;      ///< reported under another robot's number or team
  std::uint64_t phantoms = 0;       ///< reported where there is none
  std::uint64_t covered_found = 0;  ///< reported although discs were covered
  int slowest_newcomer =
      0;                 ///< frames, with the first one, until one that was put down is reported
  int longest_loss = 0;  ///< frames for which one that can be seen was lost
  double worst_error_px = 0.0;
  double rms_px = 0.0;
  double frame_us = 0.0;  ///< median time of a frame in the pipeline
};

/// Twelve league robots in pairs that touch and turn about each other while they drive; the
/// pipeline follows them. `scene`: camera, light and sensor; its first layout is the league's.
FollowingStudy study_following(vision::Scene scene, const FollowingStory& story,
                               std::uint64_t seed);

}  // namespace nadir::support
