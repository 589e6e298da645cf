#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/correction.h"
#include "fusion/gate.h"
#include "fusion/odometry_step.h"
#include "fusion/planar_pose.h"
#include "fusion/slam/association.h"
#include "fusion/slam/map_covariance.h"
#include "fusion/slam/range_bearing.h"
#include "fusion/slam/sensor_error.h"
#include "fusion/white_odometry_noise.h"

namespace nadir::fusion {

/// What became of a sighting of a landmark.
enum class SightingVerdict : std::uint8_t {
  kUsed,
  kNew,        ///< a landmark that was not known: it is in the map now
  kGated,      ///< too far from where the landmark is thought to be
  kAmbiguous,  ///< near a landmark, but neither surely it nor surely another one
  kNoRoom,     ///< new, but the map is full, or more sightings at once than kMaxSightings
  kNotFinite,  ///< a number is not finite, a range not positive
};

/// A landmark that was seen. White noise only; systematic errors are the sensor model's.
struct Sighting {
  RangeBearing measured;
  Eigen::Matrix2d covariance = sighting_covariance(0.03, 0.002);
  int name = 0;  ///< of the landmark, where the sensor can read it; otherwise of no meaning
};

struct SightingReport {
  SightingVerdict verdict = SightingVerdict::kNotFinite;
  int landmark = -1;  ///< its place in the map; -1 if there is none
  Eigen::Vector2d innovation = Eigen::Vector2d::Zero();
  double nis = 0.0;  ///< v^T S^-1 v of this sighting alone, expectation 2
};

/// How sightings without names are matched with landmarks.
enum class AssociationKind : std::uint8_t { kNearestNeighbour, kJointCompatibility };

/// Which error is linearised.
enum class ErrorKind : std::uint8_t {
  /// Positions turn with the heading's error (right-invariant error on SE_n+1(2); Barrau and
  /// Bonnabel, "An EKF-SLAM algorithm with consistency properties", 2015). The derivatives then
  /// never claim to know the heading of the whole map from landmarks alone.
  kInvariant,
  /// The textbook's: each state's own. It becomes too sure of its heading.
  kTextbook
};

/// Simultaneous localization and mapping with an extended Kalman filter: the robot's pose, the
/// error states of odometry and of the landmark sensor, and landmarks, all in one frame. It is the
/// frame in which the pose was at the start; measured poses (from a ceiling camera) hold it in the
/// world.
///
/// Cost of a step of odometry: independent of the map. Of a scan: the number of landmarks in view
/// times the square of the size of the map, which is the least that keeps all covariances exact.
/// Nothing allocates after construction.
template <OdometryErrorModel OdometryError = WhiteOdometryNoise,
          SensorErrorModel SensorError = NoSensorError>
class EkfSlam {
 public:
  static constexpr int kOdometryStates = OdometryError::kStates;
  static constexpr int kSensorStates = SensorError::kStates;
  /// Order of the head: pose, errors of the sensor, errors of odometry.
  static constexpr int kSeen = 3 + kSensorStates;  ///< of these a sighting depends on
  static constexpr int kHead = kSeen + kOdometryStates;
  using HeadVector = Eigen::Matrix<double, kHead, 1>;
  using HeadMatrix = Eigen::Matrix<double, kHead, kHead>;

  struct Settings {
    int most_landmarks = 200;
    ErrorKind error = ErrorKind::kInvariant;
    /// Largest NIS of a sighting that is believed: chi-square with 2 degrees of freedom, 99.9 %.
    double sighting_gate = 13.816;
    /// So many scans in a row in which most landmarks that are known by name (two at least) are
    /// beyond the gate mean that the pose is wrong, not they: its uncertainty grows by the sigmas
    /// below, and they are judged again. 0: never.
    int lost_after = 5;
    double lost_sigma_m = 0.5;
    double lost_sigma_rad = 0.3;
    AssociationKind association = AssociationKind::kNearestNeighbour;
    /// Largest NIS of a pair of nameless sighting and landmark that is considered (99 %), and
    /// smallest that surely is another landmark.
    double pair_gate = 9.21;
    double other_gate = 30.0;
    Gate pose_gate;
    OdometryError odometry_error;
    SensorError sensor_error;
  };

  EkfSlam() : EkfSlam(Settings{}) {}
  explicit EkfSlam(const Settings& settings);

  const Settings& settings() const { return settings_; }

  /// Starts with an empty map at a pose that is known so well.
  void start(const PlanarPose& pose, const PoseCovariance& covariance);

  /// Moves the pose by odometry's body rates over step.dt_s.
  void predict(const OdometryStep& step);
  /// Moves the pose by a displacement in the world frame (x m, y m, heading rad) whose covariance
  /// is known: for robots that know their velocity in the world. Error states keep their values.
  void move(const Eigen::Vector3d& displacement, const Eigen::Matrix3d& covariance);

  /// Landmarks seen at one time whose names the sensor read. One report for each; `reports` is as
  /// long as `sightings`. Names are 0 or above.
  void observe(std::span<const Sighting> sightings, std::span<SightingReport> reports);
  /// The same without names: matched with the map first.
  void observe_nameless(std::span<const Sighting> sightings, std::span<SightingReport> reports);

  /// A pose from outside, as PoseFilter::correct, without its recovery from lock-out.
  Correction correct(const PlanarPose& measured, const PoseCovariance& covariance);

  const PlanarPose& pose() const { return pose_; }
  PoseCovariance pose_covariance() const {
    return covariance_.head_block().template topLeftCorner<3, 3>();
  }
  auto sensor_error() const { return error_.template head<kSensorStates>(); }
  auto odometry_error() const { return error_.template tail<kOdometryStates>(); }

  /// How often the pose was found to be wrong (Settings::lost_after) since the start.
  int recoveries() const { return recoveries_; }

  int landmarks() const { return covariance_.landmarks(); }
  Eigen::Vector2d landmark_m(int landmark) const {
    return places_m_.template segment<2>(2 * landmark);
  }
  Eigen::Matrix2d landmark_covariance(int landmark) const {
    return covariance_.between(landmark, landmark);
  }
  /// As the sensor read it, or kNameless.
  int name(int landmark) const { return names_[static_cast<std::size_t>(landmark)]; }
  static constexpr int kNameless = -1;

 private:
  /// A sighting beside what is expected of a landmark.
  struct Comparison {
    Eigen::Vector2d innovation;
    Eigen::Matrix<double, 2, kSeen> by_head;  // of h(x, l) - c(z, error)
    Eigen::Matrix2d by_landmark;
    Eigen::Matrix2d noise;
  };

  int index_of(int name) const;
  Comparison compare(const Sighting& sighting, int landmark) const;
  Eigen::Matrix2d innovation_covariance(const Comparison& a, int landmark_a, const Comparison& b,
                                        int landmark_b) const;
  double nis(const Comparison& comparison, int landmark) const;
  bool refuse(const Sighting& sighting, std::size_t index, SightingReport& report) const;
  void judge_named(std::span<const Sighting> sightings, std::span<SightingReport> reports) const;
  bool is_lost(std::span<const SightingReport> reports);
  void widen_pose();
  bool find_candidates(const Sighting& sighting, int index);
  void judge_unpaired(SightingReport& report, int index, const Pairing& pairing) const;
  void correct_by_used(std::span<const Sighting> sightings,
                       std::span<const SightingReport> reports);
  void add_new(std::span<const Sighting> sightings, std::span<SightingReport> reports,
               bool has_names);
  void apply(int rank);
  void turn_positions();

  Settings settings_;
  PlanarPose pose_;
  Eigen::Matrix<double, kHead - 3, 1> error_;
  Eigen::VectorXd places_m_;
  std::vector<int> names_;
  MapCovariance covariance_;
  int lost_scans_ = 0;  // in a row
  int recoveries_ = 0;
  // Of the update that is being made.
  Eigen::MatrixXd innovation_covariance_;
  Eigen::VectorXd innovation_;
  Eigen::VectorXd change_;
  Eigen::VectorXd lean_;
  Candidates candidates_;
  std::array<Comparison, kMaxCandidates> comparisons_;
};

}  // namespace nadir::fusion

#include "fusion/slam/ekf_slam_impl.h"
