#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>

#include "control_client/drive/robot_base.h"
#include "control_client/inner_loop.h"
#include "control_client/simulation/encoders.h"
#include "control_client/simulation/plant.h"

namespace nadir::control_client {

/// The simulated robot of `nadir-client drive --simulate`.
struct SimulationSettings {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< x m, y m, heading rad
  std::uint64_t seed = 1;
  EncoderParameters encoders;
  double step_s = 0.005;  ///< of encoders and firmware, a multiple of Plant::kStep_s
};

/// The truth at one moment, in the world: x m, y m, heading rad, and their derivatives.
struct TruthSample {
  fusion::Timestamp time{0};
  fusion::PlanarPose pose;
  Eigen::Vector3d velocity_per_s = Eigen::Vector3d::Zero();
};

/// Plant and encoders as a robot base. Its steps lie on a grid of its own and are worked off when
/// time has passed, with the command that held then; without a newer command the motors get no
/// voltage once the last is no longer valid. Volts go to the motors; rim speeds and body rates
/// through the firmware's own inner loop.
class SimulatedBase : public RobotBase {
 public:
  using TruthSink = std::function<void(const TruthSample&)>;

  /// `model` outlives the base. Each step's truth goes to `on_truth`.
  SimulatedBase(const RobotModel& model, const LoopParameters& firmware,
                const SimulationSettings& settings, fusion::Timestamp now, TruthSink on_truth);

  void take_odometry(fusion::Timestamp now, std::vector<OdometryInterval>* odometry) override;
  void command(const tracker::WireWheelCommand& command, fusion::Timestamp now) override;
  std::optional<fusion::PlanarPose> truth_at(fusion::Timestamp time) const override;

  /// Somebody carries the robot away: x m, y m, heading rad.
  void displace(const Eigen::Vector3d& by) { plant_.displace(by); }

  /// Whether the last step's command was valid no longer.
  bool stopped_itself() const { return stopped_itself_; }
  const Plant& plant() const { return plant_; }

 private:
  WheelVector voltages_v(fusion::Timestamp time);
  Eigen::Vector3d wanted_rates() const;

  const RobotModel* model_;
  SimulationSettings settings_;
  Plant plant_;
  Encoders encoders_;
  InnerLoop firmware_;
  fusion::Timestamp time_;
  TruthSink on_truth_;
  tracker::WireWheelCommand command_;
  fusion::Timestamp commanded_at_{0};
  bool stopped_itself_ = true;
  Eigen::Vector3d measured_rates_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::control_client
