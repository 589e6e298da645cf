#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tracker/wire/participant.h"
#include "tracker/wire/stream_status.h"
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

  /// The same two on a participant that the process has already; the place is the participant's,
  /// not that of the options.
  PoseReader(const Participant& participant, const ReaderOptions& options);
  PoseReader(const Participant& participant, const ReaderOptions& options, Callback on_pose);

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
  FrameReader(const Participant& participant, const ReaderOptions& options);
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
