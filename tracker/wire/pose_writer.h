#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>

#include "tracker/wire/participant.h"
#include "tracker/wire/wire_options.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {

/// A robot that was not published for this long is taken off the network until it is seen again.
inline constexpr std::chrono::seconds kInstanceRetirement{2};

/// Publishes poses to the robots and frames to the monitors. One for each tracker process; not
/// thread-safe.
class PoseWriter {
 public:
  struct Status {
    int matched_pose_readers = 0;
    int matched_frame_readers = 0;
    std::uint64_t published_poses = 0;
    std::uint64_t published_frames = 0;
    std::uint64_t refused =
        0;  ///< poses and frames with values that do not belong on the wire (pose_codec.h)
    std::uint64_t failed = 0;  ///< DDS took them not
  };

  /// Throws WireError if DDS refuses.
  explicit PoseWriter(const WireOptions& options);
  explicit PoseWriter(const Participant& participant);
  PoseWriter(PoseWriter&&) noexcept;
  PoseWriter& operator=(PoseWriter&&) noexcept;
  ~PoseWriter();

  /// Publishes the poses of a frame, a keyed sample for each, and stamps publish_ns. Never throws
  /// for what DDS does: see status(). Call it for frames without robots too: it also retires those
  /// that are gone.
  void publish(std::span<const WirePose> poses);

  /// Publishes a frame summary to the monitors; a large one goes as several datagrams.
  void publish(const WireFrame& frame);

  Status status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::tracker
