// What robots, clients and trackers say beyond poses, from values to samples and back.

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "tests/support/test_values.h"
#include "tracker/wire/clock_codec.h"
#include "tracker/wire/value_codec.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Sample, typename Value>
void expect_round_trips(Value (*make)(std::uint64_t, std::int32_t)) {
  Value decoded;  // reused: what an earlier value left behind must not show
  for (std::uint64_t k = 0; k < 500; ++k) {
    const Value value = make(k, static_cast<std::int32_t>(k % 5));
    Sample sample{};
    ASSERT_TRUE(encode(value, &sample)) << k;
    ASSERT_TRUE(decode(sample, &decoded)) << k;
    ASSERT_EQ(test::difference(value, decoded), "") << k;
    ASSERT_NE(test::difference(value, make(k + 1, static_cast<std::int32_t>(k % 5))), "");
  }
}

TEST(ValueCodec, RoundTripsKeepEveryFieldToTheLastBit) {
  expect_round_trips<nadir_wire_WheelCommand>(test::test_command);
  expect_round_trips<nadir_wire_Odometry>(test::test_odometry);
  expect_round_trips<nadir_wire_ClientState>(test::test_state);
  expect_round_trips<nadir_wire_SimulatedTruth>(test::test_truth);
}

TEST(ValueCodec, EmergencyStopsRoundTrip) {
  for (const bool everybody : {false, true}) {
    WireEmergencyStop stop = test::test_stop(3);
    if (everybody) stop = WireEmergencyStop{};
    stop.engaged = !everybody;
    nadir_wire_EmergencyStop sample{};
    ASSERT_TRUE(encode(stop, &sample));
    WireEmergencyStop decoded;
    ASSERT_TRUE(decode(sample, &decoded));
    EXPECT_EQ(test::difference(stop, decoded), "");
  }
}

/// Every change of a sound value must be refused on the way out.
template <typename Sample, typename Value>
void expect_refused(const Value& sound, const std::vector<std::function<void(Value*)>>& spoil) {
  Sample sample{};
  ASSERT_TRUE(encode(sound, &sample));
  for (std::size_t i = 0; i < spoil.size(); ++i) {
    Value value = sound;
    spoil[i](&value);
    EXPECT_FALSE(encode(value, &sample)) << "case " << i;
  }
}

/// Every change of a sound sample must be refused on the way in.
template <typename Value, typename Sample>
void expect_refused_from_network(const Value& sound,
                                 const std::vector<std::function<void(Sample*)>>& spoil) {
  Sample sample{};
  ASSERT_TRUE(encode(sound, &sample));
  for (std::size_t i = 0; i < spoil.size(); ++i) {
    Sample spoilt = sample;
    spoil[i](&spoilt);
    Value decoded;
    EXPECT_FALSE(decode(spoilt, &decoded)) << "case " << i;
  }
}

TEST(ValueCodec, ImpossibleCommandsAreRefusedOnBothSides) {
  const WireWheelCommand sound = test::test_command(4, 0);  // kind 1: rim speeds
  ASSERT_EQ(sound.kind, WheelCommandKind::kRimSpeeds);
  expect_refused<nadir_wire_WheelCommand, WireWheelCommand>(
      sound, {[](WireWheelCommand* c) { c->team = std::string(kMaxTeamLength + 1, 't'); },
              [](WireWheelCommand* c) { c->wheels.values[0] = kNan; },
              [](WireWheelCommand* c) { c->wheels.values[0] = 100.1; },
              [](WireWheelCommand* c) { c->wheels.count = kMaxWireWheels + 1; },
              [](WireWheelCommand* c) { c->wheels.count = 0; },
              [](WireWheelCommand* c) { c->kind = WheelCommandKind::kBodyRates; },
              [](WireWheelCommand* c) { c->kind = static_cast<WheelCommandKind>(3); },
              [](WireWheelCommand* c) { c->valid_for_ns = 0; },
              [](WireWheelCommand* c) { c->valid_for_ns = kMaxWireInterval_ns + 1; },
              [](WireWheelCommand* c) { c->body_rates.u_mps = kInfinity; },
              [](WireWheelCommand* c) { c->body_rates.v_mps = kNan; },
              [](WireWheelCommand* c) { c->body_rates.r_radps = -1000.1; }});
  expect_refused_from_network<WireWheelCommand, nadir_wire_WheelCommand>(
      sound, {[](nadir_wire_WheelCommand* s) { s->wheels[0] = kInfinity; },
              [](nadir_wire_WheelCommand* s) { s->wheel_count = 7; },
              [](nadir_wire_WheelCommand* s) { s->kind = 200; },
              [](nadir_wire_WheelCommand* s) { s->r_radps = kNan; },
              [](nadir_wire_WheelCommand* s) { s->valid_for_ns = -1; }});
}

TEST(ValueCodec, VoltsMayBeHigherThanSpeeds) {
  WireWheelCommand command = test::test_command(5, 0);
  ASSERT_EQ(command.kind, WheelCommandKind::kVolts);
  command.wheels.values[0] = 400.0;
  nadir_wire_WheelCommand sample{};
  EXPECT_TRUE(encode(command, &sample));
  command.wheels.values[0] = 1000.1;
  EXPECT_FALSE(encode(command, &sample));
}

TEST(ValueCodec, ImpossibleOdometryIsRefusedOnBothSides) {
  const WireOdometry sound = test::test_odometry(2, 0);  // travel of three wheels
  expect_refused<nadir_wire_Odometry, WireOdometry>(
      sound, {[](WireOdometry* o) { o->t_to_ns = o->t_from_ns; },
              [](WireOdometry* o) { o->t_to_ns = o->t_from_ns + kMaxWireInterval_ns + 1; },
              [](WireOdometry* o) { o->t_from_ns = std::numeric_limits<std::int64_t>::min(); },
              [](WireOdometry* o) { o->travel_m.values[2] = kNan; },
              [](WireOdometry* o) { o->travel_m.count = 0; },
              [](WireOdometry* o) { o->kind = OdometryKind::kBodyRates; },
              [](WireOdometry* o) { o->kind = static_cast<OdometryKind>(0); },
              [](WireOdometry* o) { o->body_rates.u_mps = 1e3; }});
  expect_refused_from_network<WireOdometry, nadir_wire_Odometry>(
      sound, {[](nadir_wire_Odometry* s) { s->t_to_ns = s->t_from_ns - 1; },
              [](nadir_wire_Odometry* s) { s->wheels_m[1] = kInfinity; },
              [](nadir_wire_Odometry* s) { s->wheel_count = 255; }});
}

TEST(ValueCodec, ImpossibleClientStatesAreRefusedOnBothSides) {
  const WireClientState sound = test::test_state(1, 1);
  expect_refused<nadir_wire_ClientState, WireClientState>(
      sound, {[](WireClientState* s) { s->text = std::string(kMaxWireText + 1, 'x'); },
              [](WireClientState* s) { s->mode = static_cast<ClientMode>(6); },
              [](WireClientState* s) { s->reason = static_cast<ClientReason>(13); },
              [](WireClientState* s) { s->estimate_world_robot.heading_rad = 3.2; },
              [](WireClientState* s) { s->nominal_world_robot.x_m = kNan; },
              [](WireClientState* s) { s->error_heading_rad = -std::numbers::pi; },
              [](WireClientState* s) { s->covariance(1, 1) = -1e-12; },
              [](WireClientState* s) { s->pose_age_ns = -2; },
              [](WireClientState* s) { s->clock_sigma_ns = -2; }});
  expect_refused_from_network<WireClientState, nadir_wire_ClientState>(
      sound, {[](nadir_wire_ClientState* s) { s->mode = 6; },
              [](nadir_wire_ClientState* s) { s->reason = 255; },
              [](nadir_wire_ClientState* s) { s->covariance[8] = kNan; },
              [](nadir_wire_ClientState* s) { s->error[0] = kInfinity; }});
}

TEST(ValueCodec, StopsForEverybodyNameNobody) {
  expect_refused<nadir_wire_EmergencyStop, WireEmergencyStop>(
      WireEmergencyStop{},
      {[](WireEmergencyStop* s) { s->team = "blue"; }, [](WireEmergencyStop* s) { s->robot = 1; },
       [](WireEmergencyStop* s) { s->issuer = std::string(kMaxWireIssuer + 1, 'i'); },
       [](WireEmergencyStop* s) { s->text = std::string("a\0b", 3); }});
  expect_refused_from_network<WireEmergencyStop, nadir_wire_EmergencyStop>(
      test::test_stop(3), {[](nadir_wire_EmergencyStop* s) { s->everybody = true; }});
}

TEST(ValueCodec, ImpossibleTruthIsRefusedOnBothSides) {
  const WireSimulatedTruth sound = test::test_truth(1, 1);
  expect_refused<nadir_wire_SimulatedTruth, WireSimulatedTruth>(
      sound, {[](WireSimulatedTruth* t) { t->pose_world_robot.y_m = kNan; },
              [](WireSimulatedTruth* t) { t->pose_world_robot.heading_rad = 4.0; },
              [](WireSimulatedTruth* t) { t->velocity_x_mps = kInfinity; },
              [](WireSimulatedTruth* t) { t->velocity_y_mps = -101.0; },
              [](WireSimulatedTruth* t) { t->heading_rate_radps = kNan; }});
  expect_refused_from_network<WireSimulatedTruth, nadir_wire_SimulatedTruth>(
      sound, {[](nadir_wire_SimulatedTruth* s) { s->pose[2] = 7.0; },
              [](nadir_wire_SimulatedTruth* s) { s->velocity[2] = 1e9; }});
}

TEST(ClockCodec, RefusesTimesThatCannotBe) {
  nadir_wire_ClockReply reply{};
  reply.t1_ns = 100;
  reply.t2_ns = 200;
  reply.t3_ns = 210;
  ClockExchange exchange;
  ASSERT_TRUE(decode(reply, &exchange));
  EXPECT_EQ(exchange.t3_ns, 210);
  reply.t3_ns = 199;  // answered before it was asked
  EXPECT_FALSE(decode(reply, &exchange));
  reply.t3_ns = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(decode(reply, &exchange));
  nadir_wire_ClockRequest request{};
  request.t1_ns = -1;
  ClockQuestion question;
  EXPECT_FALSE(decode(request, &question));
}

TEST(ClockExchange, OffsetIsExactWhereBothWaysTakeTheSame) {
  // The client's clock is 3 s behind; 1 ms there, 0.2 ms in the tracker, 1 ms back.
  const std::int64_t offset_ns = 3'000'000'000;
  ClockExchange exchange;
  exchange.t1_ns = 1'700'000'000'000'000'000;
  exchange.t2_ns = exchange.t1_ns + offset_ns + 1'000'000;
  exchange.t3_ns = exchange.t2_ns + 200'000;
  exchange.t4_ns = exchange.t3_ns - offset_ns + 1'000'000;
  EXPECT_EQ(exchange.offset_ns(), offset_ns);
  EXPECT_EQ(exchange.round_trip_ns(), 2'000'000);
  // Another 4 ms on the way back: wrong by half the difference of the ways.
  exchange.t4_ns += 4'000'000;
  EXPECT_EQ(exchange.offset_ns(), offset_ns - 2'000'000);
  EXPECT_EQ(exchange.round_trip_ns(), 6'000'000);
}

TEST(ClientState, EveryModeAndReasonHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int mode = 0; mode <= static_cast<int>(ClientMode::kFinished); ++mode) {
    EXPECT_TRUE(names.insert(name_of(static_cast<ClientMode>(mode))).second) << mode;
  }
  names.clear();
  for (int reason = 0; reason <= static_cast<int>(ClientReason::kOther); ++reason) {
    EXPECT_TRUE(names.insert(name_of(static_cast<ClientReason>(reason))).second) << reason;
  }
  EXPECT_EQ(names.count("?"), 0U);
}

TEST(EmergencyStops, HoldWhomTheyNameUntilReleased) {
  EmergencyStops stops;
  WireEmergencyStop one = test::test_stop(3);  // yellow 3
  stops.apply(one);
  ASSERT_NE(stops.engaged("yellow", 3), nullptr);
  EXPECT_EQ(stops.engaged("yellow", 3)->issuer, one.issuer);
  EXPECT_EQ(stops.engaged("blue", 3), nullptr);
  EXPECT_EQ(stops.engaged("yellow", 4), nullptr);
  one.engaged = false;
  one.stamp_ns -= 1000;  // from a clock that is behind: arrival decides
  stops.apply(one);
  EXPECT_EQ(stops.engaged("yellow", 3), nullptr);
}

TEST(EmergencyStops, WithoutATeamTheyHoldTheNumberInAllTeams) {
  EmergencyStops stops;
  WireEmergencyStop stop = test::test_stop(3);
  stop.team = "";
  stops.apply(stop);
  EXPECT_NE(stops.engaged("yellow", 3), nullptr);
  EXPECT_NE(stops.engaged("blue", 3), nullptr);
  EXPECT_EQ(stops.engaged("blue", 2), nullptr);
}

TEST(EmergencyStops, ReleaseForEverybodyReleasesEachAndNotTheOtherWayRound) {
  EmergencyStops stops;
  stops.apply({});
  stops.apply(test::test_stop(3));
  WireEmergencyStop release = test::test_stop(3);
  release.engaged = false;
  stops.apply(release);
  EXPECT_NE(stops.engaged("yellow", 3), nullptr);  // the stop for everybody still holds
  stops.apply(test::test_stop(3));
  WireEmergencyStop release_all;
  release_all.engaged = false;
  stops.apply(release_all);
  EXPECT_EQ(stops.engaged("yellow", 3), nullptr);
  EXPECT_EQ(stops.engaged("blue", 0), nullptr);
}

}  // namespace
}  // namespace nadir::tracker
