#pragma once

// Real motion for tests: commanded velocities and motion capture of the two robots of UTIAS
// MR.CLAM data set 6 (Leung et al., "The UTIAS multi-robot cooperative localization and mapping
// dataset", IJRR 30(8), 2011), with a vision feed made from the motion capture.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "fusion/fuse/fuse_logs.h"

namespace nadir::fusion {

/// The feed of theory: 30 Hz, 5 mm and 1 degree of seeded Gaussian noise, a constant delay, and
/// `drop_s` seconds without frames at the end of every `drop_every_s` seconds.
struct MrclamProtocol {
  double rate_hz = 30.0;
  double sigma_position_m = 0.005;
  double sigma_heading_rad = 0.017453292519943295;
  double delay_s = 0.05;
  /// What the capture stamps leave out: positive makes frames look younger than they are.
  double undeclared_delay_s = 0.0;
  double drop_s = 0.0;
  double drop_every_s = 20.0;
  std::uint64_t seed = 1;
};

/// Times count from the first odometry row.
struct MrclamFeed {
  std::vector<OdometryRow> odometry;
  /// In order of arrival.
  std::vector<VisionRow> vision;
  std::vector<TruthRow> truth;
};

/// Where the recordings are, or nothing to read: a test that needs them skips.
std::filesystem::path mrclam_folder();
bool has_mrclam();

/// robot: 1 or 2. Throws std::runtime_error where the files are absent or unreadable.
MrclamFeed load_mrclam(int robot, const MrclamProtocol& protocol);

/// Writes odo.csv, vision.csv and truth.csv of nadir-fuse into the folder.
void write_feed(const MrclamFeed& feed, const std::filesystem::path& folder);

/// Linear interpolation of the truth (the heading on the shorter way); false where no two rows at
/// most max_gap_s apart enclose the time. `truth` is sorted by time.
bool truth_at(const std::vector<TruthRow>& truth, double t_s, double max_gap_s, PlanarPose* pose);

}  // namespace nadir::fusion
