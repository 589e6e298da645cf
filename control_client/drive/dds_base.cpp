#include "control_client/drive/dds_base.h"

#include <utility>

namespace nadir::control_client {

using fusion::Timestamp;

DdsBase::DdsBase(const tracker::Participant& participant, std::string team, std::int32_t robot,
                 const fusion::WheelGeometry& geometry)
    : reader_(participant, {.robot = robot, .team = std::move(team)}),
      writer_(participant),
      geometry_(geometry) {}

void DdsBase::take_odometry(Timestamp now, std::vector<OdometryInterval>* odometry) {
  odometry->clear();
  while (reader_.poll(&sample_, std::chrono::nanoseconds(0))) {
    if (sample_.epoch != epoch_) {
      epoch_ = sample_.epoch;
      clock_ = ArrivalClock();
    }
    OdometryInterval interval;
    if (sample_.kind == tracker::OdometryKind::kBodyRates) {
      interval.mean_rates = {sample_.body_rates.u_mps, sample_.body_rates.v_mps,
                             sample_.body_rates.r_radps};
    } else {
      if (static_cast<int>(sample_.travel_m.count) != geometry_.wheels()) {
        ++refused_;
        continue;
      }
      fusion::WheelValues speeds_mps(geometry_.wheels());
      const double length_s = 1e-9 * static_cast<double>(sample_.t_to_ns - sample_.t_from_ns);
      for (int i = 0; i < speeds_mps.size(); ++i) {
        speeds_mps(i) = sample_.travel_m.values.at(static_cast<std::size_t>(i)) / length_s;
      }
      interval.mean_rates = geometry_.body_rates(speeds_mps);
    }
    const Timestamp shift = clock_.arrived(Timestamp(sample_.t_to_ns), now);
    interval.from = Timestamp(sample_.t_from_ns) + shift;
    interval.to = Timestamp(sample_.t_to_ns) + shift;
    odometry->push_back(interval);
  }
}

void DdsBase::command(const tracker::WireWheelCommand& command, Timestamp /*now*/) {
  writer_.write(command);
}

}  // namespace nadir::control_client
