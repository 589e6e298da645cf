#include "calibration/noise/noise_from_standing.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace nadir::calibration {
namespace {

using Samples = std::span<const LoggedPose>;

/// Of the test for motion: about one window in 2,000 that stands is left out (one side, three
/// numbers a window).
constexpr double kMotionSigmas = 3.0;
/// In sigmas by the median of absolute deviations, which 20 samples know to about 20 %.
constexpr double kOutlierSigmas = 7.0;
constexpr double kSigmaOfMedianDeviation = 1.4826;
constexpr double kSamePlaceSigmas = 4.5;

double median(std::array<double, kStandingWindow> values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// One of x, y, heading over a window.
bool stands(const std::array<double, kStandingWindow>& values) {
  constexpr double kCount = kStandingWindow;
  double mean = 0.0;
  for (const double value : values) mean += value / kCount;
  double squares = 0.0;
  double steps = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    if (i > 0) steps += (values[i] - values[i - 1]) * (values[i] - values[i - 1]);
  }
  if (squares == 0.0) return true;  // no noise at all, and certainly no motion
  const double sigma = std::sqrt(4.0 * (kCount - 2.0) / (kCount * kCount - 1.0));
  if (steps / squares < 2.0 - kMotionSigmas * sigma) return false;

  const double middle = median(values);
  std::array<double, kStandingWindow> deviations{};
  std::transform(values.begin(), values.end(), deviations.begin(),
                 [middle](double value) { return std::abs(value - middle); });
  const double limit = kOutlierSigmas * kSigmaOfMedianDeviation * median(deviations);
  return *std::max_element(deviations.begin(), deviations.end()) <= limit;
}

bool window_stands(Samples window) {
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, kStandingWindow> values{};
    std::transform(window.begin(), window.end(), values.begin(),
                   [axis](const LoggedPose& pose) { return pose.pose[axis]; });
    if (!stands(values)) return false;
  }
  return true;
}

struct Moments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Moments moments(Samples samples) {
  Moments result;
  for (const LoggedPose& each : samples) result.mean += each.pose;
  result.mean /= static_cast<double>(samples.size());
  for (const LoggedPose& each : samples) {
    const Eigen::Vector3d deviation = each.pose - result.mean;
    result.covariance += deviation * deviation.transpose();
  }
  result.covariance /= static_cast<double>(samples.size() - 1);
  return result;
}

/// Whether a window continues a span: their means differ by no more than their noise.
bool same_place(Samples span, Samples window) {
  const Moments a = moments(span);
  const Moments b = moments(window);
  const double share = 1.0 / static_cast<double>(span.size()) + 1.0 / kStandingWindow;
  for (int axis = 0; axis < 3; ++axis) {
    const double variance = std::max(a.covariance(axis, axis), b.covariance(axis, axis)) * share;
    const double difference = a.mean[axis] - b.mean[axis];
    if (difference * difference > kSamePlaceSigmas * kSamePlaceSigmas * variance) return false;
  }
  return true;
}

/// What a radian of heading error moves the origin by, as published.
Eigen::Vector2d lever_m(Samples samples) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const LoggedPose& each : samples) {
    if (!(each.covariance(2, 2) > 0.0)) continue;
    sum += each.covariance.block<2, 1>(0, 2) / each.covariance(2, 2);
    ++count;
  }
  return count > 0 ? Eigen::Vector2d(sum / count) : Eigen::Vector2d::Zero();
}

/// Least squares of the deviations in metres on those in pixels: the noise itself shows the map.
/// Zero where the noise does not span the image's plane.
Eigen::Matrix2d jacobian_m_per_px(Samples samples, const Eigen::Vector3d& mean) {
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  for (const LoggedPose& each : samples) mean_px += each.centre_px;
  mean_px /= static_cast<double>(samples.size());
  Eigen::Matrix2d pixel_squares = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  for (const LoggedPose& each : samples) {
    const Eigen::Vector2d deviation_px = each.centre_px - mean_px;
    pixel_squares += deviation_px * deviation_px.transpose();
    products += (each.pose - mean).head<2>() * deviation_px.transpose();
  }
  const double determinant = pixel_squares.determinant();
  const double trace = pixel_squares.trace();
  if (!(determinant > 1e-6 * trace * trace)) return Eigen::Matrix2d::Zero();
  return products * pixel_squares.inverse();
}

StandingSpan span_of(const LoggedTrack& track, Samples samples) {
  const Moments found = moments(samples);
  StandingSpan span;
  span.file = track.file;
  span.robot = track.robot;
  span.samples = static_cast<int>(samples.size());
  span.covariance = found.covariance;
  span.pixels.assign(samples.front().pixels.size(), 0.0);
  for (const LoggedPose& each : samples) {
    for (std::size_t i = 0; i < span.pixels.size(); ++i) {
      span.pixels[i] += each.pixels[i] / static_cast<double>(samples.size());
    }
  }
  Eigen::Matrix<double, 2, 3> to_middle = Eigen::Matrix<double, 2, 3>::Identity();
  to_middle.col(2) = -lever_m(samples);
  span.middle_variance_axes_m2 = (to_middle * found.covariance * to_middle.transpose()).diagonal();
  span.middle_variance_m2 = span.middle_variance_axes_m2.mean();
  for (const LoggedPose& each : samples) {
    const double share = 1.0 / static_cast<double>(samples.size());
    span.published_middle_variance_m2 +=
        share * (to_middle * each.covariance * to_middle.transpose()).trace() / 2.0;
    if (each.aligned) span.aligned_share += share;
  }
  span.jacobian_m_per_px = jacobian_m_per_px(samples, found.mean);
  return span;
}

/// Appends the spans of one track.
void add_spans(const LoggedTrack& track, StandingData& data) {
  const Samples all(track.poses);
  constexpr std::size_t kWindow = kStandingWindow;
  std::size_t begin = 0;  // of the open span
  std::size_t end = 0;    // behind it
  const auto close = [&] {
    if (end >= begin + 2 * kWindow)
      data.spans.push_back(span_of(track, all.subspan(begin, end - begin)));
  };
  for (std::size_t next = 0; next + kWindow <= all.size(); next += kWindow) {
    const Samples window = all.subspan(next, kWindow);
    const bool standing = window_stands(window);
    const bool continues = standing && end == next && end > begin &&
                           same_place(all.subspan(begin, end - begin), window);
    if (!continues) {
      close();
      begin = next;
      end = next;
    }
    if (standing) end = next + kWindow;
  }
  close();
}

}  // namespace

StandingData find_standing(const std::vector<LoggedTrack>& tracks) {
  StandingData data;
  double time_s = 0.0;
  double steps = 0.0;
  for (const LoggedTrack& track : tracks) {
    add_spans(track, data);
    data.samples += static_cast<int>(track.poses.size());
    if (track.poses.empty()) continue;
    time_s += track.poses.back().time_s - track.poses.front().time_s;
    steps += static_cast<double>(track.poses.size() - 1);
  }
  data.moving_samples = data.samples;
  for (const StandingSpan& span : data.spans) data.moving_samples -= span.samples;
  if (time_s > 0.0) data.rate_hz = steps / time_s;
  return data;
}

}  // namespace nadir::calibration
