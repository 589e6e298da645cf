#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "control_client/simulation/random_stream.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// A pose as it comes from the simulated camera, with what only the simulation knows of it.
struct VisionFrame {
  std::uint64_t number = 0;  ///< of the frame, from 0
  int capture_tick = 0;
  int arrival_tick = 0;
  fusion::PlanarPose pose_world_robot;                  ///< measured
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();  ///< of x, y, heading: m^2, m^2, rad^2
  bool is_lost = false;                                 ///< never arrives
  bool is_outlier = false;                              ///< has nothing to do with the truth
};

/// Times of no sight. All in seconds since the start.
struct Blackout {
  double from_s = 0.0;
  double until_s = 0.0;
};

/// Losses that come in bursts (Gilbert's channel), instead of independent ones.
struct BurstLoss {
  double share = 0.1;   ///< of all frames that is lost
  double mean_s = 0.4;  ///< of a burst
};

/// The simulated camera and its way to the robot.
struct VisionParameters {
  int ticks_per_frame = 2;     ///< 2 is 25 Hz at a tick of 20 ms
  double min_delay_s = 0.060;  ///< capture to arrival, uniform, rounded up to whole ticks
  double max_delay_s = 0.100;
  double loss = 0.10;        ///< share of frames
  double outliers = 0.05;    ///< share of frames
  double min_pixels = 20.0;  ///< of each of the two discs, uniform
  double max_pixels = 50.0;
  double outlier_reach_m = 0.75;  ///< outliers are uniform in a square around the origin
  std::optional<Blackout> blackout;
  std::optional<BurstLoss> burst_loss;
  /// Worse light for x below this: both discs have dim_min_pixels to dim_max_pixels there.
  std::optional<double> dim_below_x_m;
  double dim_min_pixels = 5.0;
  double dim_max_pixels = 15.0;
};

/// Variances of x, y (m^2) and heading (rad^2) of a pose from two discs with these pixel counts, by
/// the classes of S3 Tables 1 to 3. Counts below 5 count as 5.
Eigen::Vector3d pose_variances(double centre_pixels, double outer_pixels);

/// Takes the robot's true pose every few ticks and gives frames when they are due. Draws per frame,
/// in this order: delay, three normals, loss, outlier flag, three uniforms of the outlier; pixel
/// counts and bursts have streams of their own.
class VisionFeed {
 public:
  VisionFeed(const VisionParameters& parameters, double tick_s, std::uint64_t run_seed);

  /// Whether a frame is captured at this tick (from 1).
  bool captures_at(int tick) const { return tick % parameters_.ticks_per_frame == 0; }
  /// Captures a frame; also one that will be lost is returned.
  VisionFrame capture(int tick, const fusion::PlanarPose& truth);
  /// Frames that arrive at this tick, in order of capture.
  std::vector<VisionFrame> arrivals(int tick);

 private:
  bool is_lost(int tick, double uniform);

  VisionParameters parameters_;
  double tick_s_;
  RandomStream stream_;
  RandomStream pixel_stream_;
  RandomStream burst_stream_;
  bool in_burst_ = false;
  std::uint64_t next_number_ = 0;
  std::vector<VisionFrame> on_the_way_;
};

}  // namespace nadir::control_client
