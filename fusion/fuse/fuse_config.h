#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fusion/gap_motion.h"
#include "fusion/gate.h"
#include "fusion/odometry_check.h"
#include "fusion/planar_pose.h"
#include "fusion/white_odometry_noise.h"

namespace nadir::fusion {

/// How far a pose walks away by the odometry's white noise within a second; twice as far in four.
/// Commanded velocities are wrong along the robot's way more than across.
struct OdometryWalk {
  double u_m_per_sqrt_s = 0.006;
  double v_m_per_sqrt_s = 0.004;
  double r_rad_per_sqrt_s = 0.05;

  WhiteOdometryNoise noise() const;
};

/// A place that is known before the first pose arrives.
struct KnownStart {
  PlanarPose pose;
  double sigma_m = 0.001;
  double sigma_rad = 0.01;
};

/// Everything that nadir-fuse can be told beside its logs. The defaults are one set for encoders
/// and for commanded velocities.
struct FuseConfig {
  OdometryWalk walk;
  /// Odometry is valid so much later than it is stamped: commands lead the motion.
  double odometry_lead_s = 0.0;
  OdometryCheck odometry_check;
  /// Frames are so much older than their capture stamps say.
  double vision_undeclared_delay_s = 0.0;
  double vision_future_tolerance_s = 0.02;
  Gate gate;
  LockOutRecovery recovery;
  GapMotion gap;
  /// How late a frame may come and still be used, s.
  double history_s = 1.0;
  std::optional<KnownStart> start;

  FuseConfig();
};

/// Reads a configuration; what it does not say keeps its default. Throws vision::InputError with
/// file:line:column.
FuseConfig load_fuse_config(const std::filesystem::path& file);

/// The whole configuration as YAML that load_fuse_config reads back.
std::string fuse_config_yaml(const FuseConfig& config);

}  // namespace nadir::fusion
