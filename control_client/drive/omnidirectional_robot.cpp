#include "control_client/drive/omnidirectional_robot.h"

#include <utility>

#include "control_client/slip_tolerance.h"

namespace nadir::control_client {
namespace {

// The base needs a model that lives as long as it.
class OwningBase : public RobotBase {
 public:
  OwningBase(const RobotConfig& config, const SimulationSettings& settings, fusion::Timestamp now,
             SimulatedBase::TruthSink on_truth)
      : model_(config.robot),
        base_(model_, config.control.inner, settings, now, std::move(on_truth)) {}

  void take_odometry(fusion::Timestamp now, std::vector<OdometryInterval>* odometry) override {
    base_.take_odometry(now, odometry);
  }
  void command(const tracker::WireWheelCommand& command, fusion::Timestamp now) override {
    base_.command(command, now);
  }
  std::optional<fusion::PlanarPose> truth_at(fusion::Timestamp time) const override {
    return base_.truth_at(time);
  }

 private:
  RobotModel model_;
  SimulatedBase base_;
};

}  // namespace

DrivenRobot load_omnidirectional_robot(const std::filesystem::path& file) {
  DrivenRobot robot;
  if (!file.empty()) robot.config = load_robot(file);
  robot.config.control = tolerating_slip(RobotModel(robot.config.robot), robot.config.control);
  robot.simulated = [config = robot.config](const SimulationSettings& settings,
                                            fusion::Timestamp now,
                                            SimulatedBase::TruthSink on_truth) {
    return std::make_unique<OwningBase>(config, settings, now, std::move(on_truth));
  };
  return robot;
}

}  // namespace nadir::control_client
