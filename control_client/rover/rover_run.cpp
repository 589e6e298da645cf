#include "control_client/rover/rover_run.h"

#include <Eigen/LU>
#include <cmath>

#include "control_client/simulation/random_stream.h"

namespace nadir::control_client {
namespace {

/// What the sensor sees of the landmarks.
class LandmarkSensor {
 public:
  LandmarkSensor(const RoverWorld& world, std::uint64_t seed)
      : world_(world), random_(seed, RandomPurpose::kLandmarks) {}

  std::span<const fusion::Sighting> see(const fusion::PlanarPose& pose) {
    scan_.clear();
    // A uniform error between +- a has the variance a^2 / 3.
    const Eigen::Matrix2d covariance = fusion::sighting_covariance(
        world_.range_error_m / std::sqrt(3.0), world_.bearing_error_rad / std::sqrt(3.0));
    for (std::size_t i = 0; i < world_.landmarks_m.size(); ++i) {
      fusion::RangeBearing seen = fusion::predicted_sighting(pose, world_.landmarks_m[i]).seen;
      if (seen.range_m > world_.sensor_range_m) continue;
      seen.range_m += random_.uniform(-world_.range_error_m, world_.range_error_m);
      seen.bearing_rad = fusion::wrap_angle(
          seen.bearing_rad + random_.uniform(-world_.bearing_error_rad, world_.bearing_error_rad));
      scan_.push_back({seen, covariance, static_cast<int>(i)});
    }
    return scan_;
  }

 private:
  const RoverWorld& world_;
  RandomStream random_;
  std::vector<fusion::Sighting> scan_;
};

RoverTick tick_of(double time_s, const fusion::PlanarPose& truth, const fusion::EkfSlam<>& slam) {
  const Eigen::Vector3d error = fusion::pose_difference(slam.pose(), truth);
  return {time_s, truth, slam.pose(), error.dot(slam.pose_covariance().inverse() * error)};
}

/// Landmarks of the map in the world's order; those that were never seen at infinity.
std::vector<Eigen::Vector2d> map_of(const fusion::EkfSlam<>& slam, std::size_t landmarks) {
  std::vector<Eigen::Vector2d> map(landmarks, Eigen::Vector2d::Constant(INFINITY));
  for (int i = 0; i < slam.landmarks(); ++i) {
    map[static_cast<std::size_t>(slam.name(i))] = slam.landmark_m(i);
  }
  return map;
}

}  // namespace

RoverRecord run_rover(const RoverWorld& world, const NavigatorSettings& settings,
                      std::uint64_t seed) {
  constexpr double kLost_m = 1.0;
  constexpr double kAway_m = 100.0;
  RoverPlant plant(RoverModel(settings.rover), world.losses);
  RoverNavigator navigator(settings, world.way_points_m);
  LandmarkSensor sensor(world, seed);
  plant.start(world.start);
  navigator.start(world.start, 1e-12 * fusion::PoseCovariance::Identity());
  RoverRecord record;
  double nis_sum = 0.0;
  int used = 0;
  const int ticks = static_cast<int>(std::lround(world.duration_s / settings.tick_s));
  for (int k = 0; k <= ticks; ++k) {
    const double time_s = k * settings.tick_s;
    const bool looks = k > 0 || world.looks_first;
    const Eigen::Vector3d wheels_n =
        navigator.tick(looks ? sensor.see(plant.pose()) : std::span<const fusion::Sighting>());
    for (const fusion::SightingReport& report : navigator.reports()) {
      if (report.verdict != fusion::SightingVerdict::kUsed) continue;
      nis_sum += report.nis;
      ++used;
    }
    record.ticks.push_back(tick_of(time_s, plant.pose(), navigator.slam()));
    if (record.tour_done_s < 0.0 && navigator.tour().is_done()) record.tour_done_s = time_s;
    const RoverTick& now = record.ticks.back();
    const double off_m = (now.estimate.position_m() - now.truth.position_m()).norm();
    const double away_m = (now.truth.position_m() - world.start.position_m()).norm();
    if (!(off_m < kLost_m) || !(away_m < kAway_m) || !wheels_n.allFinite()) {
      record.diverged_s = time_s;
      break;
    }
    plant.drive(wheels_n, settings.tick_s);
  }
  record.nis = used > 0 ? nis_sum / used : 0.0;
  record.map_m = map_of(navigator.slam(), world.landmarks_m.size());
  return record;
}

}  // namespace nadir::control_client
