#pragma once

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace nadir::tracker {

/// Where on the network a writer or reader lives. Only those with the same domain and partition
/// meet.
struct WireOptions {
  std::uint32_t domain = 0;  ///< 0 to kMaxDomain
  std::string partition;     ///< empty: the default partition
};

/// Higher domains use UDP ports in the range that the system hands out by itself.
inline constexpr std::uint32_t kMaxDomain = 101;

/// A writer that says nothing for this long counts as lost, even if its process cannot say
/// good-bye.
inline constexpr std::chrono::milliseconds kLivelinessLease{200};

/// Longest pause between two poses of a robot that is seen: five frames of the slowest camera in
/// use (25 Hz).
inline constexpr std::chrono::milliseconds kPoseDeadline{200};

/// DDS refuses to work: thrown while writers and readers are built, never afterwards. Says what and
/// why.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nadir::tracker
