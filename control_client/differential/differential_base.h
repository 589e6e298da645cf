#pragma once

#include "control_client/differential/differential_file.h"
#include "control_client/differential/unicycle.h"
#include "control_client/drive/robot_base.h"
#include "control_client/drive/simulated_base.h"

namespace nadir::control_client {

/// The simulated robot with two driven wheels as a robot base: its firmware brings the wheels to
/// their speeds with a lag, the wheels slip. As SimulatedBase: steps on a grid of its own, and
/// without a newer command it stops once the last is no longer valid. Volts are not for this robot
/// and stop it.
class DifferentialBase : public RobotBase {
 public:
  DifferentialBase(const DifferentialParameters& robot, const SimulationSettings& settings,
                   fusion::Timestamp now, SimulatedBase::TruthSink on_truth);

  void take_odometry(fusion::Timestamp now, std::vector<OdometryInterval>* odometry) override;
  void command(const tracker::WireWheelCommand& command, fusion::Timestamp now) override;
  std::optional<fusion::PlanarPose> truth_at(fusion::Timestamp time) const override;

  const UnicycleMotion& motion() const { return motion_; }

 private:
  UnicycleMotion wanted() const;
  void advance();

  DifferentialParameters robot_;
  SimulationSettings settings_;
  fusion::WheelGeometry geometry_;
  Encoders encoders_;
  fusion::Timestamp time_;
  SimulatedBase::TruthSink on_truth_;
  tracker::WireWheelCommand command_;
  fusion::Timestamp commanded_at_{0};
  fusion::PlanarPose pose_;
  UnicycleMotion motion_;
};

}  // namespace nadir::control_client
