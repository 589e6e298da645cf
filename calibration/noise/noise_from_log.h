#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "vision/pixel.h"

namespace nadir::calibration {

/// One robot in one frame of a tracker's pose log, as far as its noise matters.
struct LoggedPose {
  double time_s = 0.0;  ///< of capture, from the file's first frame
  Eigen::Vector3d pose =
      Eigen::Vector3d::Zero();  ///< x m, y m, heading rad without jumps of a turn
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< as published
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();
  std::vector<double> pixels;  ///< seen of each marker, above 0
  bool aligned = false;        ///< with the pixels, not made of detected marks
};

/// All of one robot that one file holds, in the order of capture.
struct LoggedTrack {
  std::string file;
  std::string robot;  ///< for messages: "blue 3 of cam0"
  std::vector<LoggedPose> poses;
};

/// Reads POSES.jsonl (nadir-tracker --poses). Throws InputError with file:line: not readable, not
/// such a log, numbers missing, a robot without markers.
std::vector<LoggedTrack> load_pose_tracks(const std::filesystem::path& file);

}  // namespace nadir::calibration
