#pragma once

#include <functional>

#include "control_client/drive/robot_base.h"
#include "control_client/drive/simulated_base.h"
#include "control_client/rover/rover_file.h"
#include "control_client/rover/rover_firmware.h"
#include "control_client/rover/rover_plant.h"

namespace nadir::control_client {

/// What trajectory and estimate have to know of the rover: its body and its wheels. Its wheels are
/// driven by forces, so there are no motors behind these numbers.
RobotParameters rover_description(const RoverParameters& rover);

/// The simulated rover as a robot base: plant, encoders, and firmware that follows body rates. As
/// SimulatedBase: steps on a grid of its own, and without a newer command no force once the last is
/// no longer valid. Rim speeds are taken as the body rates that they are of; volts are not for this
/// robot and are zero force.
class RoverBase : public RobotBase {
 public:
  RoverBase(const RoverRobot& rover, const SimulationSettings& settings, fusion::Timestamp now,
            SimulatedBase::TruthSink on_truth);

  void take_odometry(fusion::Timestamp now, std::vector<OdometryInterval>* odometry) override;
  void command(const tracker::WireWheelCommand& command, fusion::Timestamp now) override;
  std::optional<fusion::PlanarPose> truth_at(fusion::Timestamp time) const override;

  /// Whether the last step's command was valid no longer.
  bool stopped_itself() const { return stopped_itself_; }
  const RoverPlant& plant() const { return plant_; }

 private:
  Eigen::Vector3d wheel_forces_n();
  fusion::BodyRates wanted_rates() const;

  SimulationSettings settings_;
  fusion::WheelGeometry geometry_;
  RoverPlant plant_;
  RoverFirmware firmware_;
  Encoders encoders_;
  fusion::Timestamp time_;
  SimulatedBase::TruthSink on_truth_;
  tracker::WireWheelCommand command_;
  fusion::Timestamp commanded_at_{0};
  bool stopped_itself_ = true;
  fusion::BodyRates measured_;
};

}  // namespace nadir::control_client
