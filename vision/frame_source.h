#pragma once

#include <string>

#include "vision/frame.h"

namespace nadir::vision {

/// What a call of FrameSource::read brought.
enum class ReadStatus {
  kFrame,        ///< `frame` holds a new picture
  kEnd,          ///< the recording is over; every later call says so again
  kSkipped,      ///< one picture could not be read: see `message`; go on reading
  kUnavailable,  ///< the camera is away; the source keeps trying: see `message`; go on reading
};

struct ReadResult {
  ReadStatus status = ReadStatus::kEnd;
  std::string message;  ///< one line for a person, with the file or device; empty with kFrame
};

/// Where frames come from: a folder, a video file, a camera, a synthetic scene.
/// Constructors of sources throw InputError on input that can never work.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Waits for the next picture (at most about 100 ms while a camera is away) and writes it into
  /// `frame`, whose image buffer is used again where its size fits. Never throws on a bad picture
  /// or a lost camera.
  virtual ReadResult read(Frame& frame) = 0;

  /// True for a camera in real time, whose frames come at their own pace.
  virtual bool is_live() const { return false; }
};

}  // namespace nadir::vision
