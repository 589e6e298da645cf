#include "tracker/evaluation/evaluation_logs.h"

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

using Json = nlohmann::json;
using vision::InputError;

/// Calls `take` with the object of every line that is not empty.
void for_each_line(const std::filesystem::path& file,
                   const std::function<void(const Json&)>& take) {
  std::ifstream stream(file);
  if (!stream) {
    throw InputError({file.string()}, "cannot be read", "give a file of JSON lines");
  }
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty()) continue;
    try {
      take(Json::parse(line));
    } catch (const Json::parse_error&) {
      throw InputError({file.string(), number}, "is not a JSON object", "was the writer cut off?");
    } catch (const Json::exception& error) {
      const std::string text =
          error.what();  // "[json.exception.out_of_range.403] key ... not found"
      throw InputError({file.string(), number}, text.substr(text.find(']') + 2),
                       "see the file's format in data/README.md");
    }
  }
}

LoggedRobot read_robot(const Json& json) {
  LoggedRobot robot;
  robot.id = json.at("id").get<int>();
  robot.team = json.at("team").get<std::string>();
  robot.pose_world_robot = {json.at("x_m").get<double>(), json.at("y_m").get<double>(),
                            json.at("heading_rad").get<double>()};
  robot.centre_px = {json.at("u_px").get<double>(), json.at("v_px").get<double>()};
  return robot;
}

LoggedFrame read_frame(const Json& json) {
  LoggedFrame frame;
  frame.frame = json.at("frame").get<std::uint64_t>();
  frame.capture_ns = json.at("capture_ns").get<std::int64_t>();
  for (const Json& robot : json.at("robots")) frame.robots.push_back(read_robot(robot));
  return frame;
}

void read_covariance(const Json& json, fusion::PoseCovariance& covariance) {
  const Json& numbers = json.at("covariance");
  std::size_t next = 0;  // row by row
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      covariance(row, column) = numbers.at(next++).get<double>();
    }
  }
}

}  // namespace

std::vector<LoggedFrame> read_truth(const std::filesystem::path& file) {
  std::vector<LoggedFrame> frames;
  for_each_line(file, [&](const Json& json) { frames.push_back(read_frame(json)); });
  return frames;
}

std::vector<LoggedFrame> read_poses(const std::filesystem::path& file) {
  std::vector<LoggedFrame> frames;
  for_each_line(file, [&](const Json& json) {
    LoggedFrame frame = read_frame(json);
    frame.detect_us = json.at("stages_us").at("detect").get<double>();
    frame.total_us = json.at("stages_us").at("total").get<double>();
    for (std::size_t i = 0; i < frame.robots.size(); ++i) {
      read_covariance(json.at("robots").at(i), frame.robots[i].covariance);
    }
    frames.push_back(std::move(frame));
  });
  return frames;
}

std::vector<ReceivedPose> read_received(const std::filesystem::path& file) {
  std::vector<ReceivedPose> poses;
  for_each_line(file, [&](const Json& json) {
    poses.push_back({json.at("frame").get<std::uint64_t>(), json.at("id").get<int>(),
                     json.at("team").get<std::string>(), json.at("publish_ns").get<std::int64_t>(),
                     json.at("receive_ns").get<std::int64_t>()});
  });
  return poses;
}

}  // namespace nadir::tracker
