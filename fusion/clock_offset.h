#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "fusion/timestamp.h"

namespace nadir::fusion {

/// The four stamps of a question from the robot to the server and its answer.
struct ClockExchange {
  Timestamp robot_sent{0};       ///< robot's clock
  Timestamp server_received{0};  ///< server's clock
  Timestamp server_sent{0};      ///< server's clock
  Timestamp robot_received{0};   ///< robot's clock
};

/// What became of an exchange.
enum class ClockVerdict : std::uint8_t {
  kUsed,         ///< the fastest of its span of time so far
  kSlower,       ///< a faster one of the same span is known
  kTooSlow,      ///< the round trip took too long to say anything
  kImpossible,   ///< a stamp zero or before, an answer before its question
  kContradicts,  ///< cannot be true if no clock was set: kept aside
  kStepped       ///< enough of these agree: a clock was set, all before is forgotten
};
inline constexpr std::size_t kClockVerdicts = 6;

/// The server's clock as seen from the robot's.
struct ClockReading {
  std::chrono::nanoseconds offset{0};  ///< server minus robot
  double drift_ppm = 0.0;              ///< growth of the offset, 1e-6 s per second
  /// Standard deviation, as far as the two ways of a message take equally long when nothing else
  /// is on the way; a constant difference between them cannot be seen and is within bound_s.
  double sigma_s = 0.0;
  double drift_sigma_ppm = 0.0;
  /// The error is never larger, however different the two ways are, unless the drift changes faster
  /// than the settings say: about half of the shortest round trip.
  double bound_s = 0.0;
};

/// Offset and drift of the server's clock against the robot's, from two-way exchanges.
///
/// An exchange says server - robot = ((t2 - t1) + (t3 - t4)) / 2, wrong by at most half of the
/// round trip (t4 - t1) - (t3 - t2), and by the more the longer something waited on one of the two
/// ways. So only the fastest exchange of each span of time is kept (minimum-delay filter), and a
/// weighted line through the kept ones gives offset and drift; the line must pass all their bounds.
/// A clock that is set contradicts these bounds. Fixed memory, no allocation.
class ClockOffset {
 public:
  struct Settings {
    std::chrono::nanoseconds span = std::chrono::seconds(1);
    double stamp_sigma_s = 20e-6;    ///< of a stamp by itself
    double expected_drift_ppm = 50;  ///< standard deviation of clocks before anything is known
    double largest_drift_ppm = 200;
    double drift_wander_ppm = 0.5;  ///< how far drift may change within the memory
    std::chrono::nanoseconds slowest = std::chrono::milliseconds(500);  ///< round trip
    int step_after = 3;  ///< so many contradicting exchanges that agree are a step; at most 8
  };

  ClockOffset() : ClockOffset(Settings{}) {}
  explicit ClockOffset(const Settings& settings) : settings_(settings) {}

  /// In the order in which the answers come.
  ClockVerdict add(const ClockExchange& exchange);

  /// At a time of the robot's clock; nothing before the first exchange.
  std::optional<ClockReading> at(Timestamp robot_time) const;
  /// A stamp of the server on the robot's clock; nothing before the first exchange.
  std::optional<Timestamp> robot_time(Timestamp server_time) const;

  std::uint64_t count(ClockVerdict verdict) const {
    return counts_.at(static_cast<std::size_t>(verdict));
  }

 private:
  static constexpr std::size_t kSpans = 64;
  static constexpr std::size_t kAside = 8;

  struct Sample {
    Timestamp time{0};                   // of the robot, middle of the exchange
    std::chrono::nanoseconds offset{0};  // server minus robot
    double round_trip_s = 0.0;
  };
  // offset(t) = base + offset_s + drift (t - time), with the covariance of the two.
  struct Line {
    Timestamp time{0};
    std::chrono::nanoseconds base{0};
    double offset_s = 0.0;
    double drift = 0.0;
    double offset_variance = 0.0;
    double covariance = 0.0;
    double drift_variance = 0.0;
    double waiting_s = 0.0;  // weighted mean of half of what round trips took beyond the shortest
  };
  struct Interval {
    double low_s;
    double high_s;
  };

  ClockVerdict judge(const ClockExchange& exchange);
  ClockVerdict keep(const Sample& sample);
  ClockVerdict keep_aside(const Sample& sample);
  bool contradicts(const Sample& sample) const;
  bool agree(const Sample& a, const Sample& b) const;
  double drift_tolerance() const;
  double line_at(Timestamp time) const;
  Interval possible_at(Timestamp time) const;
  void fit();

  Settings settings_;
  std::array<Sample, kSpans> samples_ = {};  // ring, the newest at (first_ + size_ - 1) % kSpans
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::array<Sample, kAside> aside_ = {};
  std::size_t aside_size_ = 0;
  Line line_;
  std::array<std::uint64_t, kClockVerdicts> counts_ = {};
};

}  // namespace nadir::fusion
