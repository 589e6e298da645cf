#include "tests/bench/cold_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <opencv2/core.hpp>
#include <span>
#include <stdexcept>

#include "tests/bench/blob_pipeline.h"
#include "tests/bench/byte_sum.h"
#include "tests/bench/thread_cpu_clock.h"
#include "tests/support/accuracy_study.h"
#include "tracker/camera_pipeline.h"
#include "vision/synthetic/renderer.h"

namespace nadir::bench {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr int kVariants = 4;
constexpr std::size_t kCachesFull = 5;  // bytes of all frames over the last-level cache's

/// Of the cache that this core shares with its neighbours; a large one where the system is silent.
std::size_t last_level_cache_bytes() {
  std::ifstream file("/sys/devices/system/cpu/cpu0/cache/index3/size");
  std::size_t kib = 0;
  if (file >> kib && kib > 0) return 1024 * kib;
  return std::size_t{64} << 20;
}

struct Buffer {
  cv::Mat image;
  std::uint64_t sum = 0;  ///< of its bytes, counted one by one
};

std::vector<Buffer> render_buffers(vision::Renderer& renderer) {
  const vision::CameraParameters& camera = renderer.camera().parameters();
  const std::size_t frame_bytes =
      3 * static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  const std::size_t least = kCachesFull * last_level_cache_bytes() / frame_bytes + 1;
  std::vector<Buffer> buffers((least + kVariants - 1) / kVariants * kVariants);
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    cv::Mat& image = buffers[i].image;
    renderer.render(i, image);
    buffers[i].sum = std::accumulate(image.datastart, image.dataend, std::uint64_t{0});
  }
  return buffers;
}

void check_sum(std::uint64_t sum, const Buffer& buffer) {
  if (sum != buffer.sum) throw std::runtime_error("a sum of bytes is wrong");
}

/// CPU time that `work` takes, added to `times_us`.
template <typename Work>
void time(std::vector<double>& times_us, Work&& work) {
  const double start_us = thread_cpu_us();
  work();
  times_us.push_back(thread_cpu_us() - start_us);
}

Cost cost(std::vector<double> times_us) {
  if (times_us.empty()) return {};
  std::sort(times_us.begin(), times_us.end());
  const std::size_t n = times_us.size();
  return {times_us[n / 2], times_us[n / 4], times_us[3 * n / 4]};
}

constexpr int kRoundsBefore = 8;

/// Everything that is measured, on the same frames.
class Contest {
 public:
  Contest(vision::Renderer& renderer, std::vector<Buffer> buffers, tracker::PoseSource source)
      : buffers_(std::move(buffers)),
        capture_time_(renderer.capture_time(0)),
        pipeline_({.camera = "cam0",
                   .calibration = support::calibrate_from_scene(renderer.scene(), kSeed),
                   .calibration_file = "scene",
                   .layouts = renderer.scene().layouts,
                   .source = source},
                  renderer.camera().width_px(), renderer.camera().height_px()),
        blobs_(renderer.scene().layouts.front(), pixels_per_metre(renderer)) {}

  /// nadir and both ways to read once, each on a frame that the others meet a quarter of the
  /// buffers later.
  void round(int number) {
    const Buffer& first = buffer_of(number, 0);
    std::uint64_t sum = 0;
    time(in_order_us, [&] { sum = byte_sum_in_order(bytes(first)); });
    check_sum(sum, first);

    frame_.image = buffer_of(number, 1).image;
    frame_.number = static_cast<std::uint64_t>(number);
    frame_.capture_time = capture_time_ + std::chrono::milliseconds(20) * number;
    time(nadir_us, [&] { pipeline_.process(frame_, 0.0, report_); });
    nadir_robots += report_.robots.size();
    nadir_rejected +=
        report_.rejected.size() + static_cast<std::size_t>(report_.rejected_not_listed);

    const Buffer& third = buffer_of(number, 2);
    time(two_streams_us, [&] { sum = byte_sum_two_streams(bytes(third)); });
    check_sum(sum, third);
  }

  void opencv_round(int number) {
    int grouped = 0;
    time(opencv_us, [&] { grouped = blobs_.count_robots(buffer_of(number, 3).image); });
    opencv_robots += static_cast<std::size_t>(grouped);
  }

  void forget() {
    for (auto* times_us : {&in_order_us, &two_streams_us, &nadir_us, &opencv_us}) times_us->clear();
    nadir_robots = 0;
    nadir_rejected = 0;
    opencv_robots = 0;
  }

  std::vector<double> in_order_us, two_streams_us, nadir_us, opencv_us;
  std::size_t nadir_robots = 0;
  std::size_t nadir_rejected = 0;
  std::size_t opencv_robots = 0;

 private:
  const Buffer& buffer_of(int number, int variant) const {
    const std::size_t n = buffers_.size();
    return buffers_[(static_cast<std::size_t>(number) + n / kVariants * variant) % n];
  }
  static std::span<const std::uint8_t> bytes(const Buffer& buffer) {
    return {buffer.image.datastart, buffer.image.dataend};
  }
  static double pixels_per_metre(const vision::Renderer& renderer) {
    const double height_m = renderer.scene().layouts.front().height_m;
    return std::sqrt(
        std::abs(renderer.camera().pixels_per_metre({0.0, 0.0, height_m}).determinant()));
  }

  std::vector<Buffer> buffers_;
  vision::CaptureTime capture_time_;
  tracker::CameraPipeline pipeline_;
  BlobPipeline blobs_;
  vision::Frame frame_;
  tracker::FrameReport report_;
};

}  // namespace

double SearchCosts::reading_us() const {
  return std::min(read_in_order.median_us, read_two_streams.median_us);
}

SearchCosts measure_cold_search(const SearchCase& search_case, int measurements) {
  vision::Renderer renderer(search_case.scene, kSeed);
  std::vector<Buffer> buffers = render_buffers(renderer);
  SearchCosts costs;
  costs.name = search_case.name;
  costs.width_px = renderer.camera().width_px();
  costs.height_px = renderer.camera().height_px();
  costs.robots = static_cast<int>(renderer.placements(0).size());
  costs.buffers = static_cast<int>(buffers.size());
  costs.measurements = measurements;
  Contest contest(renderer, std::move(buffers), search_case.source);
  contest.round(0);  // lists and pictures grow to their size
  for (int i = 1; i < kRoundsBefore; ++i) contest.round(i);  // robots are known by then
  if (search_case.beside_opencv) contest.opencv_round(0);
  contest.forget();
  for (int i = 0; i < measurements; ++i) contest.round(i + kRoundsBefore);
  for (int i = 0; search_case.beside_opencv && i < measurements; ++i) {
    contest.opencv_round(i + kRoundsBefore);
  }
  costs.read_in_order = cost(contest.in_order_us);
  costs.read_two_streams = cost(contest.two_streams_us);
  costs.nadir = cost(contest.nadir_us);
  costs.opencv = cost(contest.opencv_us);
  costs.nadir_robots = static_cast<double>(contest.nadir_robots) / measurements;
  costs.nadir_rejected = static_cast<double>(contest.nadir_rejected) / measurements;
  costs.opencv_robots = static_cast<double>(contest.opencv_robots) / measurements;
  return costs;
}

vision::Scene enlarged(vision::Scene scene, int factor) {
  vision::CameraParameters& camera = scene.camera;
  camera.width_px *= factor;
  camera.height_px *= factor;
  camera.focal_px *= factor;
  // Pixel (0, 0) has its centre at (0, 0): its outer corner is at (-0.5, -0.5) in both pictures.
  camera.centre_u_px = factor * (camera.centre_u_px + 0.5) - 0.5;
  camera.centre_v_px = factor * (camera.centre_v_px + 0.5) - 0.5;
  return scene;
}

}  // namespace nadir::bench
