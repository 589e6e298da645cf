#include "control_client/simulation/vision_feed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace nadir::control_client {
namespace {

// S3 Table 1 (m^2) and Tables 2 and 3 (rad^2); rows: class of the centre disc, columns: of the
// outer one. Classes are half open: 5, 10, 20, 30, 40 pixels and more.
constexpr std::array<double, 5> kVarianceX_m2 = {1.5e-5, 9.25e-6, 4.84e-6, 4.15e-6, 1.96e-6};
constexpr std::array<double, 5> kVarianceY_m2 = {1.9e-5, 7.36e-6, 4.86e-6, 3.80e-6, 2.21e-6};
constexpr double kVarianceHeading_rad2[5][5] = {
    {0.14, 8e-2, 1.2e-2, 1e-2, 6.2e-3},       {1.6e-2, 9.9e-3, 1.3e-2, 6.6e-3, 4.6e-3},
    {1.5e-2, 9.9e-3, 7.2e-3, 4.9e-3, 3.9e-3}, {1.4e-2, 9.5e-3, 5.9e-3, 4.4e-3, 2.9e-3},
    {1.4e-2, 7.2e-3, 5.77e-3, 3e-3, 3e-3},
};

std::size_t pixel_class(double pixels) {
  constexpr std::array<double, 4> kFrom = {10.0, 20.0, 30.0, 40.0};
  return static_cast<std::size_t>(
      std::distance(kFrom.begin(), std::upper_bound(kFrom.begin(), kFrom.end(), pixels)));
}

}  // namespace

Eigen::Vector3d pose_variances(double centre_pixels, double outer_pixels) {
  const std::size_t centre = pixel_class(centre_pixels);
  const std::size_t outer = pixel_class(outer_pixels);
  return {kVarianceX_m2[centre], kVarianceY_m2[centre], kVarianceHeading_rad2[centre][outer]};
}

VisionFeed::VisionFeed(const VisionParameters& parameters, double tick_s, std::uint64_t run_seed)
    : parameters_(parameters),
      tick_s_(tick_s),
      stream_(run_seed, RandomPurpose::kVision),
      pixel_stream_(run_seed, RandomPurpose::kPixelCounts),
      burst_stream_(run_seed, RandomPurpose::kBurstLoss) {}

// Two states: in a burst every frame is lost, outside none. A burst ends with the chance of one
// frame in its mean length; it starts so often that `share` of the time is in bursts.
bool VisionFeed::is_lost(int tick, double uniform) {
  bool lost = uniform < parameters_.loss;
  if (parameters_.burst_loss) {
    const double frame_s = parameters_.ticks_per_frame * tick_s_;
    const double end = frame_s / parameters_.burst_loss->mean_s;
    const double start =
        end * parameters_.burst_loss->share / (1.0 - parameters_.burst_loss->share);
    const double drawn = burst_stream_.uniform();
    in_burst_ = in_burst_ ? drawn >= end : drawn < start;
    lost = in_burst_;
  }
  const double time_s = tick * tick_s_;
  const auto& blackout = parameters_.blackout;
  return lost || (blackout && time_s >= blackout->from_s && time_s < blackout->until_s);
}

VisionFrame VisionFeed::capture(int tick, const fusion::PlanarPose& truth) {
  const bool is_dim = parameters_.dim_below_x_m && truth.x_m < *parameters_.dim_below_x_m;
  const double low = is_dim ? parameters_.dim_min_pixels : parameters_.min_pixels;
  const double high = is_dim ? parameters_.dim_max_pixels : parameters_.max_pixels;
  const double centre_pixels = pixel_stream_.uniform(low, high);
  const double outer_pixels = pixel_stream_.uniform(low, high);

  VisionFrame frame;
  frame.number = next_number_++;
  frame.capture_tick = tick;
  frame.variances = pose_variances(centre_pixels, outer_pixels);
  const double delay_s = stream_.uniform(parameters_.min_delay_s, parameters_.max_delay_s);
  // A delay of whole ticks must not become one more by rounding.
  frame.arrival_tick = tick + static_cast<int>(std::ceil(delay_s / tick_s_ - 1e-9));
  const Eigen::Vector3d deviation = frame.variances.cwiseSqrt();
  const double error_x_m = deviation.x() * stream_.normal();
  const double error_y_m = deviation.y() * stream_.normal();
  const double error_heading_rad = deviation.z() * stream_.normal();
  frame.is_lost = is_lost(tick, stream_.uniform());
  frame.is_outlier = stream_.uniform() < parameters_.outliers;
  const double reach_m = parameters_.outlier_reach_m;
  const double false_x_m = stream_.uniform(-reach_m, reach_m);
  const double false_y_m = stream_.uniform(-reach_m, reach_m);
  const double false_heading_rad = stream_.uniform(-std::numbers::pi, std::numbers::pi);
  if (frame.is_outlier) {
    frame.pose_world_robot = {false_x_m, false_y_m, false_heading_rad};
  } else {
    frame.pose_world_robot = {truth.x_m + error_x_m, truth.y_m + error_y_m,
                              fusion::wrap_angle(truth.heading_rad + error_heading_rad)};
  }
  if (!frame.is_lost) on_the_way_.push_back(frame);
  return frame;
}

std::vector<VisionFrame> VisionFeed::arrivals(int tick) {
  std::vector<VisionFrame> due;
  std::copy_if(on_the_way_.begin(), on_the_way_.end(), std::back_inserter(due),
               [&](const VisionFrame& frame) { return frame.arrival_tick <= tick; });
  std::erase_if(on_the_way_, [&](const VisionFrame& frame) { return frame.arrival_tick <= tick; });
  return due;
}

}  // namespace nadir::control_client
