#include "calibration/noise/noise_from_log.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

using Json = nlohmann::json;
using vision::InputError;

constexpr const char* kRemedy = "give what nadir-tracker --poses wrote";

Eigen::Matrix3d read_covariance(const Json& numbers) {
  Eigen::Matrix3d covariance;
  std::size_t next = 0;  // row by row
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      covariance(row, column) = numbers.at(next++).get<double>();
    }
  }
  return covariance;
}

LoggedPose read_pose(const Json& robot, double time_s) {
  LoggedPose pose;
  pose.time_s = time_s;
  pose.pose = {robot.at("x_m").get<double>(), robot.at("y_m").get<double>(),
               robot.at("heading_rad").get<double>()};
  pose.covariance = read_covariance(robot.at("covariance"));
  pose.centre_px = {robot.at("u_px").get<double>(), robot.at("v_px").get<double>()};
  pose.pixels = robot.at("pixels").get<std::vector<double>>();
  pose.aligned = robot.value("aligned", false);
  return pose;
}

bool is_sound(const LoggedPose& pose) {
  bool sound = pose.pose.allFinite() && pose.covariance.allFinite() && pose.centre_px.allFinite() &&
               !pose.pixels.empty();
  for (const double pixels : pose.pixels) sound = sound && pixels > 0.0 && pixels < 1e9;
  return sound;
}

/// The same heading within half a turn of the one before.
double unwrapped(double heading_rad, double before_rad) {
  return before_rad + std::remainder(heading_rad - before_rad, 2.0 * std::numbers::pi);
}

/// The tracks of a file as its lines come.
class TrackShelf {
 public:
  explicit TrackShelf(std::string file) : file_(std::move(file)) {}

  void take(const Json& frame) {
    const auto capture_ns = frame.at("capture_ns").get<std::int64_t>();
    if (!first_ns_) first_ns_ = capture_ns;
    const double time_s = 1e-9 * static_cast<double>(capture_ns - *first_ns_);
    const auto camera = frame.at("camera").get<std::string>();
    for (const Json& robot : frame.at("robots")) {
      const std::string name = robot.at("team").get<std::string>() + " " +
                               std::to_string(robot.at("id").get<int>()) + " of " + camera;
      add(name, read_pose(robot, time_s));
    }
  }

  std::vector<LoggedTrack> tracks() && {
    std::vector<LoggedTrack> all;
    for (auto& [name, track] : tracks_) all.push_back(std::move(track));
    return all;
  }

 private:
  void add(const std::string& name, LoggedPose pose) {
    if (!is_sound(pose)) throw std::domain_error("robot " + name + " has no sound pose or pixels");
    LoggedTrack& track = tracks_[name];
    track.file = file_;
    track.robot = name;
    const bool other_markers =
        !track.poses.empty() && track.poses.back().pixels.size() != pose.pixels.size();
    if (other_markers) throw std::domain_error("robot " + name + " changes its number of markers");
    if (!track.poses.empty()) {
      pose.pose.z() = unwrapped(pose.pose.z(), track.poses.back().pose.z());
    }
    track.poses.push_back(std::move(pose));
  }

  std::string file_;
  std::optional<std::int64_t> first_ns_;
  std::map<std::string, LoggedTrack> tracks_;
};

}  // namespace

std::vector<LoggedTrack> load_pose_tracks(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw InputError({file.string()}, "cannot be read", kRemedy);
  }
  TrackShelf shelf(file.string());
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty()) continue;
    try {
      shelf.take(Json::parse(line));
    } catch (const Json::parse_error&) {
      throw InputError({file.string(), number}, "is not a JSON object", kRemedy);
    } catch (const Json::exception& error) {
      const std::string text = error.what();  // "[json.exception.out_of_range.403] key ..."
      throw InputError({file.string(), number}, text.substr(text.find(']') + 2), kRemedy);
    } catch (const std::domain_error& error) {
      throw InputError({file.string(), number}, error.what(), kRemedy);
    }
  }
  return std::move(shelf).tracks();
}

}  // namespace nadir::calibration
