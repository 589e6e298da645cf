#pragma once

#include <cstdint>
#include <string>

#include "control_client/drive/arrival_clock.h"
#include "control_client/drive/robot_base.h"
#include "fusion/wheel_geometry.h"
#include "tracker/wire/participant.h"
#include "tracker/wire/value_streams.h"

namespace nadir::control_client {

/// A robot base on the network: odometry in, wheel commands out. Its clock may be another than the
/// robot's; what it says is moved to the robot's clock by the fastest arrivals.
class DdsBase : public RobotBase {
 public:
  /// Throws tracker::WireError.
  DdsBase(const tracker::Participant& participant, std::string team, std::int32_t robot,
          const fusion::WheelGeometry& geometry);

  void take_odometry(fusion::Timestamp now, std::vector<OdometryInterval>* odometry) override;
  void command(const tracker::WireWheelCommand& command, fusion::Timestamp now) override;

  /// Samples with another number of wheels than the robot has.
  std::uint64_t refused() const { return refused_; }

 private:
  tracker::OdometryReader reader_;
  tracker::WheelCommandWriter writer_;
  fusion::WheelGeometry geometry_;
  ArrivalClock clock_;
  tracker::WireOdometry sample_;
  std::uint64_t epoch_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace nadir::control_client
