#pragma once

#include <sys/types.h>

namespace nadir::bench {

/// CPU time that a process has taken so far, s; 0 if it is gone.
double process_cpu_s(pid_t pid);

/// Its resident memory, MB; 0 if it is gone.
double process_memory_mb(pid_t pid);

}  // namespace nadir::bench
