#include "tracker/wire/value_codec.h"

#include "tracker/wire/codec_parts.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {
namespace {

static_assert(sizeof(nadir_wire_ClientState::team) == kMaxTeamLength + 1);
static_assert(sizeof(nadir_wire_ClientState::text) == kMaxWireText + 1);
static_assert(sizeof(nadir_wire_EmergencyStop::text) == kMaxWireText + 1);
static_assert(sizeof(nadir_wire_EmergencyStop::issuer) == kMaxWireIssuer + 1);
static_assert(sizeof(nadir_wire_SimulatedTruth::team) == kMaxTeamLength + 1);

bool is_sound(const nadir_wire_ClientState& sample) {
  return sample.mode <= static_cast<std::uint8_t>(ClientMode::kFinished) &&
         sample.reason <= static_cast<std::uint8_t>(ClientReason::kOther) &&
         is_sound_pose(sample.estimate) && is_sound_covariance(sample.covariance) &&
         is_sound_pose(sample.nominal) && is_sound_pose(sample.error) && sample.pose_age_ns >= -1 &&
         sample.clock_sigma_ns >= -1;
}

bool is_sound(const nadir_wire_EmergencyStop& sample) {
  return !sample.everybody || (sample.team[0] == '\0' && sample.robot == 0);
}

bool is_sound(const nadir_wire_SimulatedTruth& sample) {
  return is_sound_pose(sample.pose) && is_within(sample.velocity[0], kMaxWireSpeed_mps) &&
         is_within(sample.velocity[1], kMaxWireSpeed_mps) &&
         is_within(sample.velocity[2], kMaxWireTurn_radps);
}

void encode_counts(const WireClientCounts& counts, nadir_wire_ClientState* sample) {
  sample->poses_accepted = counts.poses_accepted;
  sample->poses_rejected = counts.poses_rejected;
  sample->poses_late = counts.poses_late;
  sample->poses_lost = counts.poses_lost;
  sample->recoveries = counts.recoveries;
  sample->odometry_samples = counts.odometry_samples;
  sample->ticks = counts.ticks;
  sample->ticks_missed = counts.ticks_missed;
}

WireClientCounts decode_counts(const nadir_wire_ClientState& sample) {
  return {.poses_accepted = sample.poses_accepted,
          .poses_rejected = sample.poses_rejected,
          .poses_late = sample.poses_late,
          .poses_lost = sample.poses_lost,
          .recoveries = sample.recoveries,
          .odometry_samples = sample.odometry_samples,
          .ticks = sample.ticks,
          .ticks_missed = sample.ticks_missed};
}

}  // namespace

bool encode(const WireClientState& state, nadir_wire_ClientState* sample) {
  sample->robot = state.robot;
  sample->epoch = state.epoch;
  sample->number = state.sequence;
  sample->stamp_ns = state.stamp_ns;
  sample->mode = static_cast<std::uint8_t>(state.mode);
  sample->reason = static_cast<std::uint8_t>(state.reason);
  encode_pose(state.estimate_world_robot, sample->estimate);
  encode_covariance(state.covariance, sample->covariance);
  encode_pose(state.nominal_world_robot, sample->nominal);
  encode_pose({state.error_ahead_m, state.error_left_m, state.error_heading_rad}, sample->error);
  sample->pose_age_ns = state.pose_age_ns;
  encode_counts(state.counts, sample);
  sample->clock_offset_ns = state.clock_offset_ns;
  sample->clock_sigma_ns = state.clock_sigma_ns;
  return encode_text(state.team, sample->team) && encode_text(state.text, sample->text) &&
         is_sound(*sample);
}

bool decode(const nadir_wire_ClientState& sample, WireClientState* state) {
  if (!is_sound(sample)) return false;
  state->team = sample.team;
  state->robot = sample.robot;
  state->epoch = sample.epoch;
  state->sequence = sample.number;
  state->stamp_ns = sample.stamp_ns;
  state->mode = static_cast<ClientMode>(sample.mode);
  state->reason = static_cast<ClientReason>(sample.reason);
  state->text = sample.text;
  state->estimate_world_robot = decode_pose(sample.estimate);
  decode_covariance(sample.covariance, &state->covariance);
  state->nominal_world_robot = decode_pose(sample.nominal);
  state->error_ahead_m = sample.error[0];
  state->error_left_m = sample.error[1];
  state->error_heading_rad = sample.error[2];
  state->pose_age_ns = sample.pose_age_ns;
  state->counts = decode_counts(sample);
  state->clock_offset_ns = sample.clock_offset_ns;
  state->clock_sigma_ns = sample.clock_sigma_ns;
  return true;
}

bool encode(const WireEmergencyStop& stop, nadir_wire_EmergencyStop* sample) {
  sample->everybody = stop.everybody;
  sample->robot = stop.robot;
  sample->engaged = stop.engaged;
  sample->stamp_ns = stop.stamp_ns;
  return encode_text(stop.team, sample->team) && encode_text(stop.issuer, sample->issuer) &&
         encode_text(stop.text, sample->text) && is_sound(*sample);
}

bool decode(const nadir_wire_EmergencyStop& sample, WireEmergencyStop* stop) {
  if (!is_sound(sample)) return false;
  stop->everybody = sample.everybody;
  stop->team = sample.team;
  stop->robot = sample.robot;
  stop->engaged = sample.engaged;
  stop->stamp_ns = sample.stamp_ns;
  stop->issuer = sample.issuer;
  stop->text = sample.text;
  return true;
}

bool encode(const WireSimulatedTruth& truth, nadir_wire_SimulatedTruth* sample) {
  sample->robot = truth.robot;
  sample->epoch = truth.epoch;
  sample->time_ns = truth.time_ns;
  encode_pose(truth.pose_world_robot, sample->pose);
  sample->velocity[0] = truth.velocity_x_mps;
  sample->velocity[1] = truth.velocity_y_mps;
  sample->velocity[2] = truth.heading_rate_radps;
  return encode_text(truth.team, sample->team) && is_sound(*sample);
}

bool decode(const nadir_wire_SimulatedTruth& sample, WireSimulatedTruth* truth) {
  if (!is_sound(sample)) return false;
  truth->team = sample.team;
  truth->robot = sample.robot;
  truth->epoch = sample.epoch;
  truth->time_ns = sample.time_ns;
  truth->pose_world_robot = decode_pose(sample.pose);
  truth->velocity_x_mps = sample.velocity[0];
  truth->velocity_y_mps = sample.velocity[1];
  truth->heading_rate_radps = sample.velocity[2];
  return true;
}

}  // namespace nadir::tracker
