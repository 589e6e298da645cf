#include "tracker/tracker_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "tracker/camera_setup.h"
#include "tracker/simulated_robots.h"
#include "vision/pictures/codecs.h"
#include "vision/sources/open_source.h"

namespace nadir::tracker {
namespace {

constexpr std::size_t kQueueLength = 8;
constexpr std::chrono::milliseconds kPollInterval{50};
constexpr std::chrono::milliseconds kDiscoveryTime{400};

std::vector<Landmark> landmarks_of(const TrackerConfig& config) {
  std::vector<Landmark> all;
  for (const CameraConfig& camera : config.cameras) {
    all.insert(all.end(), camera.landmarks.begin(), camera.landmarks.end());
  }
  return all;
}

}  // namespace

TrackerServer::TrackerServer(const TrackerConfig& config, Console& console)
    : config_(config), console_(console), queue_(kQueueLength), landmarks_(landmarks_of(config)) {
  const bool draws = !config_.overlay.empty();
  if (draws) vision::load_codecs();
  CameraThread::Shared shared{.console = &console_,
                              .publisher = nullptr,
                              .queue = &queue_,
                              .pace = config_.effective_pace(),
                              .keep_images = draws};
  std::vector<PipelineSetup> setups;
  for (const CameraConfig& camera : config_.cameras) {
    setups.push_back(load_pipeline_setup(camera, config_.tracks));
    for (const std::string& warning : setup_warnings(setups.back())) console_.line(warning);
  }
  if (config_.publish) {
    const auto epoch = static_cast<std::uint64_t>(system_clock_ns());
    publisher_.emplace(participant(), epoch);
    clock_answerer_.emplace(participant(), epoch);
    shared.publisher = &*publisher_;
  }
  for (std::size_t i = 0; i < setups.size(); ++i) {
    if (draws) overlays_.emplace_back(setups[i].calibration.map, setups[i].layouts);
    cameras_.push_back(std::make_unique<CameraThread>(i, open_source(config_.cameras[i]),
                                                      std::move(setups[i]), shared));
  }
  if (draws) std::filesystem::create_directories(config_.overlay);
  if (!config_.poses.empty()) log_.emplace(config_.poses);
}

TrackerServer::~TrackerServer() = default;

const Participant& TrackerServer::participant() {
  if (!participant_) {
    participant_.emplace(
        WireOptions{static_cast<std::uint32_t>(config_.domain), config_.partition});
  }
  return *participant_;
}

std::unique_ptr<vision::FrameSource> TrackerServer::open_source(const CameraConfig& camera) {
  vision::SourceOptions options;
  options.rate_hz = camera.rate_hz;
  options.live_robots = [this](double hold_s) {
    const auto hold =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(hold_s));
    return std::make_shared<SimulatedRobots>(participant(), hold, console_);
  };
  return vision::open_source(camera.source, options);
}

// A recording is over soon: a listener that is there already should not miss its beginning only
// because the two processes have yet to discover each other. Without a listener nothing waits for
// long.
void TrackerServer::wait_for_listener() const {
  if (!publisher_ || config_.effective_pace() != Pace::kRecorded) return;
  const auto until = std::chrono::steady_clock::now() + kDiscoveryTime;
  while (publisher_->status().matched_pose_readers == 0 &&
         std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int TrackerServer::run(const std::atomic<bool>& stop) {
  wait_for_listener();
  for (const auto& camera : cameras_) camera->start();
  consume(stop);
  console_.end_progress();
  for (const auto& camera : cameras_) camera->join();
  return finish(stop.load());
}

void TrackerServer::consume(const std::atomic<bool>& stop) {
  FinishedFrame frame;
  while (true) {
    // An error of one camera ends the others, too.
    if (stop.load() ||
        std::ranges::any_of(cameras_, [](const auto& each) { return each->has_failed(); })) {
      for (const auto& camera : cameras_) camera->request_stop();
    }
    // Asked before the queue is: what a camera hands over before it is done is not missed.
    const bool over = all_done();
    if (queue_.pop(frame, over ? std::chrono::milliseconds(0) : kPollInterval)) {
      write(frame);
    } else if (over) {
      return;
    } else if (log_) {
      log_->flush();
    }
  }
}

bool TrackerServer::all_done() const {
  return std::ranges::all_of(cameras_, [](const auto& camera) { return camera->is_done(); });
}

void TrackerServer::write(const FinishedFrame& frame) {
  ++written_frames_;
  if (log_ && !log_->write(frame.report)) {
    throw std::runtime_error(fmt::format("{}: cannot be written (disk full, or its reader is gone)",
                                         config_.poses.string()));
  }
  if (!overlays_.empty()) write_overlay(frame);
  for (const std::string& line : landmarks_.update(frame.report)) console_.line(line);
  show_progress(frame.report);
}

void TrackerServer::write_overlay(const FinishedFrame& frame) {
  const std::string prefix = cameras_.size() > 1 ? frame.report.camera + "_" : "";
  const auto file = config_.overlay / fmt::format("{}{:06}.png", prefix, frame.report.frame);
  if (!vision::codecs().write(file.string(),
                              overlays_[frame.camera].draw(frame.image, frame.report))) {
    throw std::runtime_error(file.string() + ": cannot be written");
  }
}

void TrackerServer::show_progress(const FrameReport& report) {
  std::uint64_t held_back = 0;
  if (!progress_limit_.admit(std::chrono::steady_clock::now(), held_back)) return;
  console_.progress(fmt::format("{} frames   {}: frame {}, {} robots, {:.2f} ms", written_frames_,
                                report.camera, report.frame, report.robots.size(),
                                1e-3 * report.stages.total_us));
}

int TrackerServer::finish(bool stopped) {
  bool saw_something = true;
  for (const auto& camera : cameras_) {
    console_.line(camera->statistics().summary(camera->setup().camera));
    saw_something = saw_something && camera->statistics().frames() > 0;
  }
  if (publisher_) {
    const PoseWriter::Status status = publisher_->status();
    console_.line(
        fmt::format("published {} poses and {} frames on domain {}; {} refused, {} failed",
                    status.published_poses, status.published_frames, config_.domain, status.refused,
                    status.failed));
  }
  if (clock_answerer_ && clock_answerer_->status().answered > 0) {
    console_.line(
        fmt::format("answered {} questions about this clock", clock_answerer_->status().answered));
  }
  if (queue_.dropped() > 0) {
    console_.line(fmt::format(
        "{} frames were dropped before they were written: files are slower than the camera",
        queue_.dropped()));
  }
  if (log_ && !log_->flush())
    throw std::runtime_error(config_.poses.string() + ": cannot be written");
  if (saw_something || stopped) return 0;
  console_.line("a camera brought no frame that could be read");
  return 1;
}

}  // namespace nadir::tracker
