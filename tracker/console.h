#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace nadir::tracker {

/// The one that writes to stderr: lines of several threads stay whole, and the progress line is on
/// a terminal only.
class Console {
 public:
  Console();

  /// One line for a person.
  void line(const std::string& text);
  /// Replaces the progress line; nothing where stderr is no terminal.
  void progress(const std::string& text);
  /// Takes the progress line away.
  void end_progress();

 private:
  std::mutex mutex_;
  bool is_terminal_;
  bool shows_progress_ = false;
};

/// Lets one message through in each interval and counts the others. The caller tells the time.
class MessageLimiter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit MessageLimiter(std::chrono::steady_clock::duration interval) : interval_(interval) {}

  /// True if a message may be written now; `held_back` is then the number of those that were not.
  bool admit(Time now, std::uint64_t& held_back);
  /// Lets the next message through at once.
  void reset() { open_ = true; }

 private:
  std::chrono::steady_clock::duration interval_;
  Time last_{};
  bool open_ = true;
  std::uint64_t held_back_ = 0;
};

}  // namespace nadir::tracker
