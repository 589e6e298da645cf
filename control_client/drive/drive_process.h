#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control_client/drive/client_clock.h"
#include "control_client/drive/drive_config.h"
#include "control_client/drive/drive_core.h"
#include "control_client/drive/drive_log.h"
#include "control_client/drive/driven_robot.h"
#include "control_client/drive/robot_base.h"
#include "control_client/drive/state_announcer.h"
#include "control_client/drive/tick_scheduler.h"
#include "control_client/robot_model.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/participant.h"
#include "tracker/wire/pose_reader.h"
#include "tracker/wire/value_streams.h"

namespace nadir::control_client {

/// What one drive is told beside its configuration.
struct DriveTask {
  std::int32_t robot = 0;
  TrajectoryPtr trajectory;
  DrivenRobot body;
  bool simulates = false;
  std::filesystem::path log;         ///< empty: none
  std::optional<double> duration_s;  ///< nothing: until the trajectory is over
};

/// `nadir-client drive`: core, clock, network and robot base in one loop of one thread. The
/// threads of DDS only fill queues.
class DriveProcess {
 public:
  using Console = std::function<void(const std::string&)>;

  /// Throws tracker::WireError, std::runtime_error for a log that cannot be written.
  DriveProcess(const DriveConfig& config, const DriveTask& task, Console console);

  /// Drives until the trajectory or the time is over, or `stop` is set. The robot stands then.
  void run(const std::atomic<bool>& stop);

 private:
  void receive(fusion::Timestamp now);
  void step(std::int64_t periods);
  void report(fusion::Timestamp now);
  void ask_clock(fusion::Timestamp now);
  bool is_over() const;
  void finish();
  std::unique_ptr<RobotBase> make_base(const DriveConfig& config);
  void publish(const TruthSample& truth);
  std::string summary() const;

  DriveConfig config_;
  DriveTask task_;
  Console console_;
  RobotModel model_;
  ClientClock clock_;
  std::uint64_t epoch_;
  tracker::Participant participant_;
  tracker::PoseReader poses_;
  tracker::EmergencyStopReader stops_;
  tracker::ClockAsker asker_;
  tracker::ClientStateWriter states_;
  std::optional<tracker::SimulatedTruthWriter> truths_;
  DriveCore core_;
  TickScheduler scheduler_;
  std::unique_ptr<RobotBase> base_;
  StateAnnouncer announcer_;
  std::optional<DriveLog> log_;

  std::vector<OdometryInterval> odometry_;
  tracker::WirePose pose_;
  fusion::Timestamp started_;
  fusion::Timestamp now_;
  fusion::Timestamp next_state_{0};
  fusion::Timestamp next_question_{0};
  tracker::ClientMode told_mode_ = tracker::ClientMode::kStarting;
  std::uint64_t inner_missed_ = 0;
};

}  // namespace nadir::control_client
