#include "tracker/wire/codec_parts.h"
#include "tracker/wire/value_codec.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {
namespace {

static_assert(sizeof(nadir_wire_WheelCommand::team) == kMaxTeamLength + 1);
static_assert(sizeof(nadir_wire_Odometry::team) == kMaxTeamLength + 1);
static_assert(std::size(nadir_wire_WheelCommand{}.wheels) == kMaxWireWheels);
static_assert(std::size(nadir_wire_Odometry{}.wheels_m) == kMaxWireWheels);

template <typename Sample>
bool has_sound_rates(const Sample& sample) {
  return is_within(sample.u_mps, kMaxWireSpeed_mps) && is_within(sample.v_mps, kMaxWireSpeed_mps) &&
         is_within(sample.r_radps, kMaxWireTurn_radps);
}

bool are_sound_wheels(std::span<const double, kMaxWireWheels> wheels, std::size_t count,
                      double limit) {
  return count <= kMaxWireWheels && std::ranges::all_of(wheels.first(count), [&](double value) {
           return is_within(value, limit);
         });
}

bool is_sound(const nadir_wire_WheelCommand& sample) {
  const auto kind = static_cast<WheelCommandKind>(sample.kind);
  const bool known = kind == WheelCommandKind::kBodyRates || kind == WheelCommandKind::kRimSpeeds ||
                     kind == WheelCommandKind::kVolts;
  const bool needs_wheels = kind != WheelCommandKind::kBodyRates;
  const double limit = kind == WheelCommandKind::kVolts ? kMaxWireVoltage_v : kMaxWireSpeed_mps;
  return known && (sample.wheel_count > 0) == needs_wheels && sample.valid_for_ns > 0 &&
         sample.valid_for_ns <= kMaxWireInterval_ns && has_sound_rates(sample) &&
         are_sound_wheels(sample.wheels, sample.wheel_count, limit);
}

bool is_sound(const nadir_wire_Odometry& sample) {
  const auto kind = static_cast<OdometryKind>(sample.kind);
  const bool known = kind == OdometryKind::kBodyRates || kind == OdometryKind::kRimTravel;
  const bool needs_wheels = kind == OdometryKind::kRimTravel;
  // Compared before the difference is taken: that of two impossible times may overflow.
  const bool forward = sample.t_to_ns > sample.t_from_ns && sample.t_from_ns >= 0 &&
                       sample.t_to_ns - sample.t_from_ns <= kMaxWireInterval_ns;
  constexpr double kFarthest_m = kMaxWireSpeed_mps * 1e-9 * kMaxWireInterval_ns;
  return known && (sample.wheel_count > 0) == needs_wheels && forward && has_sound_rates(sample) &&
         are_sound_wheels(sample.wheels_m, sample.wheel_count, kFarthest_m);
}

bool encode_wheels(const WireWheels& wheels, double (&field)[kMaxWireWheels], std::uint8_t* count) {
  if (wheels.count > kMaxWireWheels) return false;
  std::ranges::fill(field, 0.0);
  std::copy_n(wheels.values.begin(), wheels.count, field);
  *count = static_cast<std::uint8_t>(wheels.count);
  return true;
}

void decode_wheels(const double (&field)[kMaxWireWheels], std::size_t count, WireWheels* wheels) {
  wheels->values.fill(0.0);
  std::copy_n(field, count, wheels->values.begin());
  wheels->count = count;
}

template <typename Sample>
void encode_rates(const WireBodyRates& rates, Sample* sample) {
  sample->u_mps = rates.u_mps;
  sample->v_mps = rates.v_mps;
  sample->r_radps = rates.r_radps;
}

}  // namespace

bool encode(const WireWheelCommand& command, nadir_wire_WheelCommand* sample) {
  sample->robot = command.robot;
  sample->epoch = command.epoch;
  sample->number = command.sequence;
  sample->stamp_ns = command.stamp_ns;
  sample->valid_for_ns = command.valid_for_ns;
  sample->kind = static_cast<std::uint8_t>(command.kind);
  encode_rates(command.body_rates, sample);
  return encode_text(command.team, sample->team) &&
         encode_wheels(command.wheels, sample->wheels, &sample->wheel_count) && is_sound(*sample);
}

bool decode(const nadir_wire_WheelCommand& sample, WireWheelCommand* command) {
  if (!is_sound(sample)) return false;
  command->team = sample.team;
  command->robot = sample.robot;
  command->epoch = sample.epoch;
  command->sequence = sample.number;
  command->stamp_ns = sample.stamp_ns;
  command->valid_for_ns = sample.valid_for_ns;
  command->kind = static_cast<WheelCommandKind>(sample.kind);
  command->body_rates = {sample.u_mps, sample.v_mps, sample.r_radps};
  decode_wheels(sample.wheels, sample.wheel_count, &command->wheels);
  return true;
}

bool encode(const WireOdometry& odometry, nadir_wire_Odometry* sample) {
  sample->robot = odometry.robot;
  sample->epoch = odometry.epoch;
  sample->number = odometry.sequence;
  sample->t_from_ns = odometry.t_from_ns;
  sample->t_to_ns = odometry.t_to_ns;
  sample->kind = static_cast<std::uint8_t>(odometry.kind);
  encode_rates(odometry.body_rates, sample);
  return encode_text(odometry.team, sample->team) &&
         encode_wheels(odometry.travel_m, sample->wheels_m, &sample->wheel_count) &&
         is_sound(*sample);
}

bool decode(const nadir_wire_Odometry& sample, WireOdometry* odometry) {
  if (!is_sound(sample)) return false;
  odometry->team = sample.team;
  odometry->robot = sample.robot;
  odometry->epoch = sample.epoch;
  odometry->sequence = sample.number;
  odometry->t_from_ns = sample.t_from_ns;
  odometry->t_to_ns = sample.t_to_ns;
  odometry->kind = static_cast<OdometryKind>(sample.kind);
  odometry->body_rates = {sample.u_mps, sample.v_mps, sample.r_radps};
  decode_wheels(sample.wheels_m, sample.wheel_count, &odometry->travel_m);
  return true;
}

}  // namespace nadir::tracker
