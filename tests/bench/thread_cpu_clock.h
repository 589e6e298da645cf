#pragma once

#include <ctime>

namespace nadir::bench {

/// CPU time of the calling thread, microseconds. Not wall-clock time: it stands still while other
/// processes have the core.
inline double thread_cpu_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

}  // namespace nadir::bench
