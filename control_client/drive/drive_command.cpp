#include "control_client/drive/drive_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <utility>

#include "control_client/drive/drive_config.h"
#include "control_client/drive/drive_process.h"
#include "control_client/drive/printed_config.h"
#include "control_client/drive/realtime_priority.h"
#include "control_client/drive/robot_kinds.h"
#include "control_client/trajectory_file.h"
#include "tracker/wire/wire_types.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

Eigen::Vector3d place_of(const std::vector<double>& numbers) {
  return {numbers.at(0), numbers.at(1), numbers.at(2) * std::numbers::pi / 180.0};
}

DriveConfig effective_config(const DriveOptions& options) {
  DriveConfig config;
  if (!options.config.empty()) config = load_drive_config(options.config);
  if (options.domain) config.domain = *options.domain;
  if (options.partition) config.partition = *options.partition;
  if (options.team) config.team = *options.team;
  if (!options.robot_file.empty()) config.robot = options.robot_file;
  if (!options.robot_type.empty()) config.robot_type = options.robot_type;
  if (options.speed) config.speed = *options.speed;
  if (options.fits_limits) config.fits_limits = true;
  if (options.repeats || options.duration_s) config.plan.repeats = true;
  if (!options.place.empty()) config.place = place_of(options.place);
  if (!options.start.empty()) config.start = place_of(options.start);
  if (options.seed) config.simulation.seed = static_cast<std::uint64_t>(*options.seed);
  if (options.clock_error_s) config.clock_error.offset_s = *options.clock_error_s;
  if (config.team.empty() || config.team.size() > tracker::kMaxTeamLength) {
    throw vision::InputError({"nadir-client", 0, 0}, "'" + config.team + "' is no team's name",
                             "1 to 15 bytes, as in the layout of the robots");
  }
  return config;
}

TrajectoryPtr trajectory_for(const DrivenRobot& robot, const std::string& name,
                             const DriveConfig& config) {
  const RobotModel model(robot.config.robot);
  TrajectoryPtr trajectory = config.fits_limits ? fitting_trajectory(name, model, config.speed)
                                                : choose_trajectory(name, model, config.speed);
  return robot.suited ? robot.suited(name, std::move(trajectory)) : trajectory;
}

}  // namespace

void run_drive_command(const DriveOptions& options, const std::atomic<bool>& stop) {
  DriveConfig config = effective_config(options);
  DriveTask task;
  task.robot = options.robot;
  task.body = load_driven_robot(config.robot_type, config.robot);
  if (!task.body.takes_volts && config.output == tracker::WheelCommandKind::kVolts) {
    config.output = tracker::WheelCommandKind::kBodyRates;
  }
  if (options.prints_config) {
    fmt::print("{}", printed_config(config, task.body));
    return;
  }
  task.trajectory = placed(trajectory_for(task.body, options.trajectory, config), config.place);
  task.simulates = options.simulates;
  task.log = options.log;
  task.duration_s = options.duration_s;
  // Before the threads of DDS are started: they inherit it.
  take_realtime_priority(config.realtime_priority);
  DriveProcess process(config, task,
                       [](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  process.run(stop);
}

}  // namespace nadir::control_client
