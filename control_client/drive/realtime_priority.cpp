#include "control_client/drive/realtime_priority.h"

#include <pthread.h>
#include <sched.h>

namespace nadir::control_client {

bool take_realtime_priority(int priority) {
  if (priority <= 0) return false;
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace nadir::control_client
