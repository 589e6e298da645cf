#include "tracker/wire/clock_codec.h"

namespace nadir::tracker {
namespace {

// So that sums and differences of times cannot overflow.
constexpr std::int64_t kYear2200_ns = 7'258'118'400'000'000'000;

bool is_sound_time(std::int64_t time_ns) { return time_ns >= 0 && time_ns < kYear2200_ns; }

}  // namespace

bool decode(const nadir_wire_ClockRequest& sample, ClockQuestion* question) {
  if (!is_sound_time(sample.t1_ns)) return false;
  question->client = sample.client;
  question->sequence = sample.number;
  question->t1_ns = sample.t1_ns;
  return true;
}

bool decode(const nadir_wire_ClockReply& sample, ClockExchange* exchange) {
  const bool sound = is_sound_time(sample.t1_ns) && is_sound_time(sample.t2_ns) &&
                     is_sound_time(sample.t3_ns) && sample.t3_ns >= sample.t2_ns;
  if (!sound) return false;
  exchange->epoch = sample.epoch;
  exchange->sequence = sample.number;
  exchange->t1_ns = sample.t1_ns;
  exchange->t2_ns = sample.t2_ns;
  exchange->t3_ns = sample.t3_ns;
  return true;
}

}  // namespace nadir::tracker
