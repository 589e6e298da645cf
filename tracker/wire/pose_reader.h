#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tracker/wire/wire_options.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {

/// Which poses a reader hands out; an empty field lets all pass.
struct PoseFilter {
  std::optional<std::int32_t> robot;
  std::string team;
  std::string camera;
};

struct ReaderOptions {
  WireOptions wire;
  PoseFilter filter;                 ///< FrameReader heeds the camera only
  std::size_t queue_capacity = 256;  ///< a full queue drops its oldest entry
};

struct ReaderStatus {
  int matched_writers = 0;             ///< discovered and compatible
  int alive_writers = 0;               ///< of these, heard of within kLivelinessLease
  int peers = 0;                       ///< other DDS participants in the domain, of whatever kind
  std::uint64_t received = 0;          ///< passed the filter
  std::uint64_t dropped = 0;           ///< of these, pushed out of a full queue
  std::uint64_t malformed = 0;         ///< refused by the codec
  std::uint64_t writers_lost = 0;      ///< times a writer fell silent without a good-bye
  std::uint64_t deadlines_missed = 0;  ///< times a robot was not seen for kPoseDeadline
};

/// Receives poses, either through a queue (poll) or through a callback.
class PoseReader {
 public:
  using Callback = std::function<void(const WirePose&)>;

  /// Poses wait in the queue for poll(). Throws WireError if DDS refuses.
  explicit PoseReader(const ReaderOptions& options);

  /// on_pose is called on the thread that receives, the earliest moment possible: it must only hand
  /// over, because while it works nothing is received. Poses do not go through the queue. Throws
  /// WireError if DDS refuses.
  PoseReader(const ReaderOptions& options, Callback on_pose);

  PoseReader(PoseReader&&) noexcept;
  PoseReader& operator=(PoseReader&&) noexcept;
  ~PoseReader();

  /// Takes the oldest pose in the queue; waits for one at most `timeout`. False if none came.
  /// `pose` may be reused from call to call and keeps its memory.
  bool poll(WirePose* pose, std::chrono::nanoseconds timeout);

  ReaderStatus status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Receives frame summaries: for monitors, not for robots. Otherwise like PoseReader.
class FrameReader {
 public:
  explicit FrameReader(const ReaderOptions& options);
  FrameReader(FrameReader&&) noexcept;
  FrameReader& operator=(FrameReader&&) noexcept;
  ~FrameReader();

  bool poll(WireFrame* frame, std::chrono::nanoseconds timeout);
  ReaderStatus status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::tracker
