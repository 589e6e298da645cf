#include "tests/support/test_values.h"

namespace nadir::test {
namespace {

using tracker::WireBodyRates;
using tracker::WireClientState;
using tracker::WireEmergencyStop;
using tracker::WireOdometry;
using tracker::WireSimulatedTruth;
using tracker::WireWheelCommand;
using tracker::WireWheels;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kTick_ns = 5'000'000;

/// Numbers of one value: another one at each call.
class Numbers {
 public:
  Numbers(std::uint64_t sequence, std::int32_t robot)
      : random_(static_cast<unsigned>(1000 * sequence + static_cast<std::uint64_t>(robot) + 1)) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::uint64_t count() {
    return std::uniform_int_distribution<std::uint64_t>(1, 1U << 20)(random_);
  }
  fusion::PlanarPose pose() {
    const double x_m = (*this)(-4.0, 4.0);
    const double y_m = (*this)(-3.0, 3.0);
    return {x_m, y_m, (*this)(-3.1, 3.1)};
  }
  WireBodyRates rates() {
    const double u_mps = (*this)(-2.0, 2.0);
    const double v_mps = (*this)(-2.0, 2.0);
    return {u_mps, v_mps, (*this)(-6.0, 6.0)};
  }
  WireWheels wheels(std::size_t count) {
    WireWheels wheels;
    wheels.count = count;
    for (std::size_t i = 0; i < count; ++i) wheels.values[i] = (*this)(-5.0, 5.0);
    return wheels;
  }

 private:
  std::minstd_rand random_;
};

template <typename Value>
Value named(std::int32_t robot) {
  Value value;
  value.team = robot % 2 == 0 ? "blue" : "yellow";
  value.robot = robot;
  return value;
}

/// Collects the names of fields that differ.
class Fields {
 public:
  template <typename T>
  Fields& compare(const char* name, const T& a, const T& b) {
    if (!(a == b)) names_ += std::string(" ") + name;
    return *this;
  }
  Fields& compare(const char* name, const fusion::PlanarPose& a, const fusion::PlanarPose& b) {
    return compare(name, a.x_m == b.x_m && a.y_m == b.y_m && a.heading_rad == b.heading_rad, true);
  }
  Fields& compare(const char* name, const WireBodyRates& a, const WireBodyRates& b) {
    return compare(name, a.u_mps == b.u_mps && a.v_mps == b.v_mps && a.r_radps == b.r_radps, true);
  }
  Fields& compare(const char* name, const WireWheels& a, const WireWheels& b) {
    return compare(name, a.count == b.count && a.values == b.values, true);
  }
  std::string names() const { return names_; }

 private:
  std::string names_;
};

template <typename Value>
Fields key_difference(const Value& a, const Value& b) {
  Fields fields;
  fields.compare("team", a.team, b.team).compare("robot", a.robot, b.robot);
  return fields;
}

template <typename Value>
Fields stamp_difference(const Value& a, const Value& b) {
  Fields fields = key_difference(a, b);
  fields.compare("epoch", a.epoch, b.epoch).compare("sequence", a.sequence, b.sequence);
  return fields;
}

}  // namespace

WireWheelCommand test_command(std::uint64_t sequence, std::int32_t robot) {
  Numbers numbers(sequence, robot);
  auto command = named<WireWheelCommand>(robot);
  command.epoch = 3;
  command.sequence = sequence;
  command.stamp_ns = kStart_ns + static_cast<std::int64_t>(sequence) * kTick_ns;
  command.valid_for_ns = 40 * kTick_ns + static_cast<std::int64_t>(sequence % 7);
  command.kind = static_cast<tracker::WheelCommandKind>(sequence % 3);
  command.wheels = numbers.wheels(sequence % 3 == 0 ? 0 : 1 + sequence % 6);
  command.body_rates = numbers.rates();
  return command;
}

WireOdometry test_odometry(std::uint64_t sequence, std::int32_t robot) {
  Numbers numbers(sequence, robot);
  auto odometry = named<WireOdometry>(robot);
  odometry.epoch = 4;
  odometry.sequence = sequence;
  odometry.t_from_ns = kStart_ns + static_cast<std::int64_t>(sequence) * kTick_ns;
  odometry.t_to_ns = odometry.t_from_ns + kTick_ns;
  const bool travel = sequence % 2 == 0;
  odometry.kind = travel ? tracker::OdometryKind::kRimTravel : tracker::OdometryKind::kBodyRates;
  odometry.travel_m = numbers.wheels(travel ? 3 + sequence % 2 : 0);
  odometry.body_rates = numbers.rates();
  return odometry;
}

WireClientState test_state(std::uint64_t sequence, std::int32_t robot) {
  Numbers numbers(sequence, robot);
  auto state = named<WireClientState>(robot);
  state.epoch = 5;
  state.sequence = sequence;
  state.stamp_ns = kStart_ns + static_cast<std::int64_t>(sequence) * kTick_ns;
  state.mode = static_cast<tracker::ClientMode>(sequence % 6);
  state.reason = static_cast<tracker::ClientReason>(sequence % 13);
  state.text = "state " + std::to_string(sequence);
  state.estimate_world_robot = numbers.pose();
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = numbers(-2e-3, 2e-3);
  state.covariance = root * root.transpose();
  state.nominal_world_robot = numbers.pose();
  state.error_ahead_m = numbers(-0.1, 0.1);
  state.error_left_m = numbers(-0.1, 0.1);
  state.error_heading_rad = numbers(-0.1, 0.1);
  state.pose_age_ns = static_cast<std::int64_t>(numbers.count());
  state.counts = {.poses_accepted = numbers.count(),
                  .poses_rejected = numbers.count(),
                  .poses_late = numbers.count(),
                  .poses_lost = numbers.count(),
                  .recoveries = numbers.count(),
                  .odometry_samples = numbers.count(),
                  .ticks = numbers.count(),
                  .ticks_missed = numbers.count()};
  state.clock_offset_ns = -static_cast<std::int64_t>(numbers.count());
  state.clock_sigma_ns = static_cast<std::int64_t>(numbers.count());
  return state;
}

WireEmergencyStop test_stop(std::int32_t robot) {
  auto stop = named<WireEmergencyStop>(robot);
  stop.everybody = false;
  stop.stamp_ns = kStart_ns + robot;
  stop.issuer = "operator " + std::to_string(robot);
  stop.text = "somebody stands on the field";
  return stop;
}

WireSimulatedTruth test_truth(std::uint64_t sequence, std::int32_t robot) {
  Numbers numbers(sequence, robot);
  auto truth = named<WireSimulatedTruth>(robot);
  truth.epoch = 6;
  truth.time_ns = kStart_ns + static_cast<std::int64_t>(sequence) * kTick_ns;
  truth.pose_world_robot = numbers.pose();
  truth.velocity_x_mps = numbers(-2.0, 2.0);
  truth.velocity_y_mps = numbers(-2.0, 2.0);
  truth.heading_rate_radps = numbers(-6.0, 6.0);
  return truth;
}

std::string difference(const WireWheelCommand& a, const WireWheelCommand& b) {
  return stamp_difference(a, b)
      .compare("stamp_ns", a.stamp_ns, b.stamp_ns)
      .compare("valid_for_ns", a.valid_for_ns, b.valid_for_ns)
      .compare("kind", a.kind, b.kind)
      .compare("wheels", a.wheels, b.wheels)
      .compare("body_rates", a.body_rates, b.body_rates)
      .names();
}

std::string difference(const WireOdometry& a, const WireOdometry& b) {
  return stamp_difference(a, b)
      .compare("t_from_ns", a.t_from_ns, b.t_from_ns)
      .compare("t_to_ns", a.t_to_ns, b.t_to_ns)
      .compare("kind", a.kind, b.kind)
      .compare("travel_m", a.travel_m, b.travel_m)
      .compare("body_rates", a.body_rates, b.body_rates)
      .names();
}

std::string difference(const WireClientState& a, const WireClientState& b) {
  return stamp_difference(a, b)
      .compare("stamp_ns", a.stamp_ns, b.stamp_ns)
      .compare("mode", a.mode, b.mode)
      .compare("reason", a.reason, b.reason)
      .compare("text", a.text, b.text)
      .compare("estimate", a.estimate_world_robot, b.estimate_world_robot)
      .compare("covariance", a.covariance, b.covariance)
      .compare("nominal", a.nominal_world_robot, b.nominal_world_robot)
      .compare("error_ahead_m", a.error_ahead_m, b.error_ahead_m)
      .compare("error_left_m", a.error_left_m, b.error_left_m)
      .compare("error_heading_rad", a.error_heading_rad, b.error_heading_rad)
      .compare("pose_age_ns", a.pose_age_ns, b.pose_age_ns)
      .compare("poses_accepted", a.counts.poses_accepted, b.counts.poses_accepted)
      .compare("poses_rejected", a.counts.poses_rejected, b.counts.poses_rejected)
      .compare("poses_late", a.counts.poses_late, b.counts.poses_late)
      .compare("poses_lost", a.counts.poses_lost, b.counts.poses_lost)
      .compare("recoveries", a.counts.recoveries, b.counts.recoveries)
      .compare("odometry_samples", a.counts.odometry_samples, b.counts.odometry_samples)
      .compare("ticks", a.counts.ticks, b.counts.ticks)
      .compare("ticks_missed", a.counts.ticks_missed, b.counts.ticks_missed)
      .compare("clock_offset_ns", a.clock_offset_ns, b.clock_offset_ns)
      .compare("clock_sigma_ns", a.clock_sigma_ns, b.clock_sigma_ns)
      .names();
}

std::string difference(const WireEmergencyStop& a, const WireEmergencyStop& b) {
  return key_difference(a, b)
      .compare("everybody", a.everybody, b.everybody)
      .compare("engaged", a.engaged, b.engaged)
      .compare("stamp_ns", a.stamp_ns, b.stamp_ns)
      .compare("issuer", a.issuer, b.issuer)
      .compare("text", a.text, b.text)
      .names();
}

std::string difference(const WireSimulatedTruth& a, const WireSimulatedTruth& b) {
  return key_difference(a, b)
      .compare("epoch", a.epoch, b.epoch)
      .compare("time_ns", a.time_ns, b.time_ns)
      .compare("pose", a.pose_world_robot, b.pose_world_robot)
      .compare("velocity_x_mps", a.velocity_x_mps, b.velocity_x_mps)
      .compare("velocity_y_mps", a.velocity_y_mps, b.velocity_y_mps)
      .compare("heading_rate_radps", a.heading_rate_radps, b.heading_rate_radps)
      .names();
}

}  // namespace nadir::test
