#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "vision/frame_source.h"
#include "vision/synthetic/delivery.h"
#include "vision/synthetic/live_robots.h"
#include "vision/synthetic/renderer.h"

namespace nadir::vision {

/// How fast a synthetic camera delivers.
enum class SyntheticPace {
  kFastest,   ///< as fast as frames can be made; capture times from the scene's fixed epoch
  kRecorded,  ///< at the scene's rate, none left out; capture times from the fixed epoch
  kRealTime,  ///< like a camera: capture times are wall-clock times, frames that nobody fetched in
              ///< time are lost; the scene's `delivery` delays and drops frames
};

/// A scene as a frame source. It can start and continue at any frame.
class SyntheticSource : public FrameSource {
 public:
  /// Ends after Scene::frames frames, never if that is 0. Throws InputError for a scene that cannot
  /// be shown.
  SyntheticSource(Scene scene, std::uint64_t seed, SyntheticPace pace = SyntheticPace::kFastest);
  /// A camera in real time that shows live robots beside the scene's own: where they were at each
  /// capture time. `robots` must not be null. Throws InputError for a scene that cannot be shown.
  SyntheticSource(Scene scene, std::uint64_t seed, std::shared_ptr<LiveRobots> robots);

  ReadResult read(Frame& frame) override;
  bool is_live() const override { return pace_ == SyntheticPace::kRealTime; }

  /// The next frame that read will deliver (real time: at the earliest).
  void seek(std::uint64_t frame_number);
  /// Truth of any frame.
  const Renderer& renderer() const { return renderer_; }

 private:
  using Clock = std::chrono::steady_clock;

  void start();
  Clock::time_point exposure_time(std::uint64_t frame_number) const;
  /// Waits for the next frame's time.
  void keep_pace();
  /// Real time: passes over lost frames and waits until the next one must be made. False while
  /// there is none for longer.
  bool wait_for_delivery();
  void render(const Frame& frame, cv::Mat& image);
  void add_live_robots(CaptureTime time);

  Renderer renderer_;
  SyntheticPace pace_;
  Delivery delivery_;
  std::shared_ptr<LiveRobots> live_;  ///< null: the scene's own robots only
  std::vector<LiveRobot> live_robots_;
  std::vector<RobotPlacement> placements_;
  std::uint64_t next_ = 0;
  bool started_ = false;
  std::uint64_t first_ = 0;  ///< frame at start_
  Clock::time_point start_;
  CaptureTime start_wall_;
  Clock::time_point arrival_;         ///< of the newest frame: frames keep their order
  Clock::duration rendering_time_{};  ///< of the newest frame
};

}  // namespace nadir::vision
