#include "tracker/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace nadir::tracker {

Console::Console() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void Console::line(const std::string& text) {
  const std::lock_guard lock(mutex_);
  fmt::print(stderr, "{}{}\n", shows_progress_ ? "\r\033[K" : "", text);
  shows_progress_ = false;
}

void Console::progress(const std::string& text) {
  if (!is_terminal_) return;
  const std::lock_guard lock(mutex_);
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
  shows_progress_ = true;
}

void Console::end_progress() {
  const std::lock_guard lock(mutex_);
  if (shows_progress_) fmt::print(stderr, "\r\033[K");
  shows_progress_ = false;
}

bool MessageLimiter::admit(Time now, std::uint64_t& held_back) {
  if (!open_ && now - last_ < interval_) {
    ++held_back_;
    return false;
  }
  open_ = false;
  last_ = now;
  held_back = held_back_;
  held_back_ = 0;
  return true;
}

}  // namespace nadir::tracker
