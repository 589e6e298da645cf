#include "tracker/camera_thread.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "tracker/camera_setup.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {

using SteadyClock = std::chrono::steady_clock;

CameraThread::CameraThread(std::size_t index, std::unique_ptr<vision::FrameSource> source,
                           PipelineSetup setup, const Shared& shared)
    : index_(index), source_(std::move(source)), setup_(std::move(setup)), shared_(shared) {}

void CameraThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    try {
      run(stop);
    } catch (...) {
      error_ = std::current_exception();
      failed_ = true;
    }
    done_ = true;
  });
}

void CameraThread::join() {
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(error_);
}

void CameraThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto start = SteadyClock::now();
    const vision::ReadResult read = source_->read(frame_);
    const double read_us =
        std::chrono::duration<double, std::micro>(SteadyClock::now() - start).count();
    switch (read.status) {
      case vision::ReadStatus::kFrame:
        tell_back();
        take_frame(read_us, stop);
        break;
      case vision::ReadStatus::kSkipped:
        skip(read.message);
        break;
      case vision::ReadStatus::kUnavailable:
        tell_away(read.message);
        break;
      case vision::ReadStatus::kEnd:
        return;
    }
  }
}

void CameraThread::take_frame(double read_us, const std::stop_token& stop) {
  if (!source_->is_live() && shared_.pace == Pace::kRecorded) pace_.wait(frame_.capture_time, stop);
  if (stop.stop_requested()) return;
  if (!pipeline_) build_pipeline();
  try {
    pipeline_->process(frame_, read_us, finished_.report);
  } catch (const vision::InputError& error) {
    skip(error.what());
    return;
  }
  if (shared_.publisher != nullptr) shared_.publisher->publish(finished_.report);
  statistics_.add(finished_.report);
  hand_over(stop);
}

// The first frame shows the size; if it is not the calibration's, nothing can work and the tracker
// ends.
void CameraThread::build_pipeline() {
  const int width_px = frame_.image.cols;
  const int height_px = frame_.image.rows;
  pipeline_.emplace(setup_, width_px, height_px);
  const std::string warning = coverage_warning(setup_, width_px, height_px);
  if (!warning.empty()) shared_.console->line(warning);
}

void CameraThread::hand_over(const std::stop_token& stop) {
  finished_.camera = index_;
  if (shared_.keep_images) cv::swap(finished_.image, frame_.image);
  if (source_->is_live()) {
    shared_.queue->push_or_drop(finished_);
  } else {
    shared_.queue->push_or_wait(finished_, stop);
  }
}

void CameraThread::skip(const std::string& why) {
  statistics_.add_skipped();
  std::uint64_t held_back = 0;
  if (!skip_messages_.admit(SteadyClock::now(), held_back)) return;
  const std::string more = held_back > 0 ? fmt::format(" (and {} more)", held_back) : "";
  shared_.console->line(fmt::format("{}: skipped{}: {}", setup_.camera, more, why));
}

void CameraThread::tell_away(const std::string& why) {
  if (why != away_message_) away_messages_.reset();
  away_message_ = why;
  std::uint64_t held_back = 0;
  if (!away_messages_.admit(SteadyClock::now(), held_back)) return;
  shared_.console->line(fmt::format("{}: no frames, trying again: {}", setup_.camera, why));
}

void CameraThread::tell_back() {
  if (away_message_.empty()) return;
  away_message_.clear();
  away_messages_.reset();
  shared_.console->line(fmt::format("{}: frames again", setup_.camera));
}

}  // namespace nadir::tracker
