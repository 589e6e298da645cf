#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "tracker/camera_pipeline.h"
#include "tracker/console.h"
#include "tracker/publisher.h"
#include "tracker/recorded_pace.h"
#include "tracker/report_queue.h"
#include "tracker/run_statistics.h"
#include "tracker/tracker_config.h"
#include "vision/frame_source.h"

namespace nadir::tracker {

/// One camera at work in its own thread: read a frame, wait until it is due (recordings), make its
/// poses, publish them, hand the report to the queue. Skips what cannot be read and says so.
class CameraThread {
 public:
  /// What all cameras of a tracker share. `publisher` may be null: nothing is published.
  struct Shared {
    Console* console = nullptr;
    Publisher* publisher = nullptr;
    ReportQueue* queue = nullptr;
    Pace pace = Pace::kFastest;
    bool keep_images = false;  ///< for overlays
  };

  CameraThread(std::size_t index, std::unique_ptr<vision::FrameSource> source, PipelineSetup setup,
               const Shared& shared);

  void start();
  void request_stop() { thread_.request_stop(); }
  /// True once the recording is over, a stop was obeyed, or it failed.
  bool is_done() const { return done_.load(); }
  /// True once an error ended it: see join().
  bool has_failed() const { return failed_.load(); }
  /// Waits for the end; throws what ended the thread if it was an error.
  void join();

  const PipelineSetup& setup() const { return setup_; }
  /// After join().
  const RunStatistics& statistics() const { return statistics_; }

 private:
  void run(const std::stop_token& stop);
  void take_frame(double read_us, const std::stop_token& stop);
  void build_pipeline();
  void hand_over(const std::stop_token& stop);
  void skip(const std::string& why);
  void tell_away(const std::string& why);
  void tell_back();

  std::size_t index_;
  std::unique_ptr<vision::FrameSource> source_;
  PipelineSetup setup_;
  Shared shared_;
  std::optional<CameraPipeline> pipeline_;  // from the first frame on
  RecordedPace pace_;
  vision::Frame frame_;
  FinishedFrame finished_;
  RunStatistics statistics_;
  MessageLimiter skip_messages_{std::chrono::seconds(1)};
  MessageLimiter away_messages_{std::chrono::seconds(10)};
  std::string away_message_;  // empty while the camera is there
  std::exception_ptr error_;
  std::atomic<bool> failed_{false};
  std::atomic<bool> done_{false};
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace nadir::tracker
