#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tracker/wire/wire_types.h"

namespace nadir::tracker {

/// Remembers which robots a writer speaks of, so that those it no longer sees can be taken off the
/// network: anonymous robots get new numbers all the time, and DDS keeps every key until it is told
/// otherwise.
class InstanceLedger {
 public:
  struct Instance {
    std::string team;
    std::string camera;
    std::int32_t robot = 0;
    std::int64_t last_ns = 0;  ///< steady clock
  };

  /// The pose was published at `now_ns` (steady clock).
  void touch(const WirePose& pose, std::int64_t now_ns);

  /// Calls retire(instance) for each that was last published before `before_ns`, and forgets it.
  template <typename Retire>
  void retire_older(std::int64_t before_ns, Retire retire) {
    for (std::size_t i = 0; i < instances_.size();) {
      if (instances_[i].last_ns >= before_ns) {
        ++i;
        continue;
      }
      retire(instances_[i]);
      instances_[i] = instances_.back();
      instances_.pop_back();
    }
  }

  std::size_t size() const { return instances_.size(); }

 private:
  std::vector<Instance> instances_;
};

}  // namespace nadir::tracker
