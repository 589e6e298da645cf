#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/planar_pose.h"
#include "tracker/track_numbers.h"
#include "vision/frame.h"

namespace nadir::tracker {

/// A robot of one frame before it is known which one it is.
struct TrackCandidate {
  int kind = 0;      ///< robots of different kinds (layout, team) are never the same robot
  int read_id = -1;  ///< number read from its colours, -1 for an anonymous robot
  fusion::PlanarPose pose_world_robot;
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  double confidence = 0.0;  ///< 0 to 1
};

/// What RobotTracks says of one candidate.
struct TrackDecision {
  enum class Verdict { kReport, kDuplicate, kUncertain };
  int id = 0;  ///< robot number, or the track number of an anonymous robot
  Verdict verdict = Verdict::kReport;
};

/// When two sightings are one robot.
struct TrackSettings {
  double speed_limit_mps = 4.0;    ///< no robot is faster
  double lost_after_s = 0.7;       ///< a robot unseen for longer is a new one
  double same_place_m = 0.05;      ///< closer to the expected place than any other robot can be
  double confident_reading = 0.3;  ///< a number read with less is not believed on its first sight
};

/// Who is who from frame to frame, one per camera. Poses are only compared, never changed.
///
/// A track is a body that is followed; what is read on it are votes.
///  - A candidate continues a track of its kind by greedy choice of the nearest pair, pairs of
///  equal
///    number first. (An optimal sum could give up a certain pair for two poor ones; both choices
///    agree unless two robots are within each other's reach.) Reach is the speed limit plus three
///    sigma from where the track was last; distance counts from where its motion puts it now. A
///    candidate whose reading differs from the track's number continues it only at the same place,
///    where no second robot has room.
///  - A number that is read is reported at once. Only an established track (three equal readings
///    of a body that did not leap) has a say against a reading: it keeps its number while single
///    frames read another, until the other has more votes (four equal frames). It has no say where
///    its own number is read elsewhere in this frame: then the robots were moved, and the readings
///    are right.
///  - A number is reported once per frame. Of two claims the one wins whose established track had
///    the number when it was last seen, then the more confident, then the first.
///  - Anonymous robots get the lowest free number; a number rests before it is used again.
class RobotTracks {
 public:
  explicit RobotTracks(const TrackSettings& settings = {});

  /// One frame. The answer stands in the order of `candidates` and is valid until the next call. A
  /// capture time before the last one starts afresh. Allocates only while the numbers of robots and
  /// tracks still grow.
  std::span<const TrackDecision> update(vision::CaptureTime capture_time,
                                        std::span<const TrackCandidate> candidates);

 private:
  struct Vote {
    int id = -1;
    double weight = 0.0;
  };
  struct Track {
    int kind = 0;
    int id = -1;  // voted number, or the track number
    bool anonymous = false;
    bool read_elsewhere = false;  // its number, in this frame
    bool contradicted = false;    // and so that the track must not hold it
    bool held_number = false;     // was reported under its number when last seen
    int agreeing_readings = 0;
    std::array<Vote, 4> votes;
    fusion::PlanarPose pose;
    double position_variance_m2 = 0.0;  // larger of x and y, or above
    Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
    Eigen::Vector2d expected_m = Eigen::Vector2d::Zero();  // where it should be in this frame
    vision::CaptureTime last_seen;
    bool is_established() const;
    void vote(int read_id, double weight);
  };
  struct Pair {
    int rank;
    double distance_m;
    int candidate;
    int track;
  };

  void forget_lost(vision::CaptureTime now);
  void expect_motion(vision::CaptureTime now);
  void mark_contradicted(std::span<const TrackCandidate> candidates);
  void list_pairs(vision::CaptureTime now, std::span<const TrackCandidate> candidates);
  void assign_pairs(vision::CaptureTime now, std::span<const TrackCandidate> candidates);
  void start_track(vision::CaptureTime now, const TrackCandidate& candidate, int index);
  void continue_track(vision::CaptureTime now, const TrackCandidate& candidate, Track& track);
  void decide_numbers(std::span<const TrackCandidate> candidates);
  void settle_duplicates(std::span<const TrackCandidate> candidates);

  TrackSettings settings_;
  TrackNumbers numbers_;
  vision::CaptureTime last_update_{};
  std::vector<Track> tracks_;
  std::vector<Pair> pairs_;
  std::vector<int> track_of_candidate_;
  std::vector<char> track_taken_;
  std::vector<TrackDecision> decisions_;
};

}  // namespace nadir::tracker
