#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracker/wire/wire_types.h"

namespace nadir::test {

/// A pose with a value of its own in every field, computed from the arguments alone: the process
/// that publishes and the one that receives agree on it without talking. publish_ns is 0.
tracker::WirePose test_pose(std::uint64_t epoch, std::uint64_t frame, std::int32_t robot,
                            const std::string& camera = "cam0");

/// A frame of test poses of the robots 0 to robots - 1.
tracker::WireFrame test_frame(std::uint64_t epoch, std::uint64_t frame, std::int32_t robots,
                              const std::string& camera = "cam0");

/// Names of the fields in which the two differ, publish_ns apart; empty if they are equal to the
/// last bit.
std::string difference(const tracker::WireRobot& a, const tracker::WireRobot& b);
std::string difference(const tracker::WirePose& a, const tracker::WirePose& b);
std::string difference(const tracker::WireFrame& a, const tracker::WireFrame& b);

}  // namespace nadir::test
