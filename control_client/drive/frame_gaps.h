#pragma once

#include <array>
#include <cstdint>

namespace nadir::control_client {

/// Counts the frames of cameras that did not come, by the gaps in their numbers. Frames may come in
/// any order. Remembers the eight cameras that were heard of last.
class FrameGaps {
 public:
  /// A frame of a camera in one run of its tracker.
  void add(std::uint32_t camera, std::uint64_t epoch, std::uint64_t frame);
  std::uint64_t lost() const;

 private:
  struct Stream {
    std::uint32_t camera = 0;
    std::uint64_t epoch = 0;
    std::uint64_t heard = 0;  // when, in frames of all; 0: free
    std::uint64_t first = 0;
    std::uint64_t newest = 0;
    std::uint64_t received = 0;

    std::uint64_t lost() const {
      const std::uint64_t due = newest - first + 1;
      return due > received ? due - received : 0;
    }
  };

  std::array<Stream, 8> streams_;
  std::uint64_t frames_ = 0;
  std::uint64_t lost_of_forgotten_ = 0;
};

}  // namespace nadir::control_client
