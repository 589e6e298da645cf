#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "tracker/camera_thread.h"
#include "tracker/landmark_monitor.h"
#include "tracker/overlay.h"
#include "tracker/pose_log.h"
#include "tracker/tracker_config.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/participant.h"

namespace nadir::tracker {

/// The cameras of a configuration, one thread each, and in the caller's thread what is written of
/// them: the pose log, the overlay pictures, the progress line, warnings of landmarks that move.
class TrackerServer {
 public:
  /// Opens and checks everything that is named. Throws InputError or WireError.
  TrackerServer(const TrackerConfig& config, Console& console);
  ~TrackerServer();

  /// Runs until all recordings are over or `stop` is set; tells the summary at the end. Returns the
  /// exit code: 1 if no frame of a recording could be read or something could not be written.
  /// Throws InputError if a camera's first frame does not fit its calibration.
  int run(const std::atomic<bool>& stop);

 private:
  const Participant& participant();
  std::unique_ptr<vision::FrameSource> open_source(const CameraConfig& camera);
  void wait_for_listener() const;
  void consume(const std::atomic<bool>& stop);
  bool all_done() const;
  void write(const FinishedFrame& frame);
  void write_overlay(const FinishedFrame& frame);
  void show_progress(const FrameReport& report);
  int finish(bool stopped);

  TrackerConfig config_;
  Console& console_;
  ReportQueue queue_;
  std::optional<Participant> participant_;  // nothing while nobody needs the network
  std::optional<Publisher> publisher_;
  std::optional<ClockAnswerer> clock_answerer_;
  std::optional<PoseLog> log_;
  std::vector<Overlay> overlays_;
  LandmarkMonitor landmarks_;
  std::vector<std::unique_ptr<CameraThread>> cameras_;  // last: their threads use all the others
  std::uint64_t written_frames_ = 0;
  MessageLimiter progress_limit_{std::chrono::milliseconds(200)};
};

}  // namespace nadir::tracker
