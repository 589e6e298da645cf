#include "tests/fusion/fusion_feed.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/fusion/rate_bias_model.h"

namespace nadir::fusion::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Timestamp kStart = std::chrono::seconds(1700000000);

BodyRates smooth_rates(double time_s) {
  return {0.2 + 0.1 * std::sin(0.9 * time_s), 0.15 * std::cos(0.7 * time_s),
          0.8 * std::sin(0.5 * time_s)};
}

PoseCovariance frame_covariance(RandomStream& random) {
  const double position_m2 = std::pow(random.uniform(1.2e-3, 3e-3), 2);
  const double heading_rad2 = std::pow(random.uniform(0.03, 0.07), 2);
  const double cross = random.uniform(-0.5, 0.5) * std::sqrt(position_m2 * heading_rad2);
  PoseCovariance covariance = Eigen::Vector3d(position_m2, position_m2, heading_rad2).asDiagonal();
  covariance(1, 2) = covariance(2, 1) = cross;
  return covariance;
}

PlanarPose shifted(const PlanarPose& pose, const Eigen::Vector3d& by) {
  return {pose.x_m + by.x(), pose.y_m + by.y(), wrap_angle(pose.heading_rad + by.z())};
}

// Captures of one run, in the order of time; cameras are shifted against each other.
std::vector<Frame> captures(const FeedOptions& options, RandomStream& random) {
  std::vector<Frame> frames;
  const auto ticks = [&](double time_s) {
    return std::round(time_s / options.odometry_period_s) * options.odometry_period_s;
  };
  for (int camera = 0; camera < options.cameras; ++camera) {
    const double shift_s = camera * 0.3 * options.frame_period_s;
    for (int i = 1;; ++i) {
      double time_s = shift_s + i * options.frame_period_s;
      if (options.captures_between_ticks) {
        time_s += random.uniform(-0.3, 0.3) * options.frame_period_s;
      } else {
        time_s = ticks(time_s);
      }
      if (time_s > options.duration_s) break;
      Frame frame;
      frame.vision.camera = static_cast<std::uint32_t>(camera);
      frame.vision.frame = static_cast<std::uint64_t>(i);
      frame.vision.capture = kStart + from_seconds(time_s);
      frames.push_back(frame);
    }
  }
  std::stable_sort(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) {
    return a.vision.capture < b.vision.capture;
  });
  return frames;
}

// Moves the truth along and looks at it when a frame is captured.
class World {
 public:
  World(const FeedOptions& options, const PlanarPose& start)
      : options_(options),
        random_(3 * options.seed + 1),
        truth_(start),
        bias_(random_.normal(model_.initial_covariance())) {}

  void drive(const BodyRates& measured, double dt_s) {
    if (dt_s <= 0.0) return;
    Eigen::Matrix3d intensity = options_.rate_covariance * options_.odometry_period_s;
    BodyRates unbiased = measured;
    if (options_.has_rate_bias) {
      const OdometryStep step{measured, measured, dt_s, dt_s};
      const CorrectedRates<3> corrected = model_.corrected(step, bias_);
      const ErrorTransition<3> change = model_.transition(step);
      unbiased = corrected.rates;
      intensity = corrected.white_intensity;
      bias_ = change.transition * bias_ + random_.normal(change.noise_covariance);
    }
    const Eigen::Vector3d noise = random_.normal(Eigen::Matrix3d(intensity / dt_s));
    truth_ = moved(truth_, BodyRates::from(unbiased.vector() - noise), dt_s);
  }

  void slip() {
    truth_ = shifted(truth_, {random_.uniform(-0.05, 0.05), random_.uniform(-0.05, 0.05),
                              random_.uniform(-0.2, 0.2)});
  }

  void look(Frame& frame) {
    frame.vision.covariance = frame_covariance(random_);
    frame.vision.pose = shifted(truth_, random_.normal(frame.vision.covariance));
    frame.arrival = frame.vision.capture +
                    from_seconds(random_.uniform(options_.least_delay_s, options_.most_delay_s));
    frame.is_outlier = random_.happens(options_.outliers);
    if (frame.is_outlier) {
      frame.vision.pose = {random_.uniform(-0.75, 0.75), random_.uniform(-0.75, 0.75),
                           random_.uniform(-kPi, kPi)};
    }
  }

  AlongNominal::Nominal nominal(const BodyRates& measured) {
    return {truth_.heading_rad + 0.02 * random_.normal(), measured};
  }

  const PlanarPose& truth() const { return truth_; }

 private:
  const FeedOptions& options_;
  RandomStream random_;
  PlanarPose truth_;
  RateBiasModel model_;
  Eigen::Vector3d bias_;
};

void lose_frames(const FeedOptions& options, RandomStream& random, std::vector<Frame>& frames) {
  std::vector<Frame> kept;
  for (const Frame& frame : frames) {
    if (random.happens(options.lost)) continue;
    kept.push_back(frame);
  }
  frames = kept;
}

void lose_odometry(const FeedOptions& options, RandomStream& random, Feed& feed) {
  std::vector<OdometrySample> kept;
  std::vector<PlanarPose> truth;
  int missing = 0;
  for (std::size_t k = 0; k < feed.odometry.size(); ++k) {
    if (random.happens(options.odometry_gaps)) missing = random.whole(1, 8);
    if (missing-- > 0 && k > 0) continue;
    kept.push_back(feed.odometry[k]);
    truth.push_back(feed.truth[k]);
  }
  feed.odometry = kept;
  feed.truth = truth;
}

}  // namespace

Feed make_feed(const FeedOptions& options) {
  RandomStream random(3 * options.seed);
  Feed feed;
  feed.start = kStart;
  feed.expected_start = {0.2, -0.1, random.uniform(-kPi, kPi)};
  feed.rate_covariance = options.rate_covariance;
  feed.odometry_period_s = options.odometry_period_s;
  feed.start_covariance = options.start_covariance;
  feed.frames = captures(options, random);
  World world(options, shifted(feed.expected_start, random.normal(options.start_covariance)));

  std::size_t next = 0;
  const int samples = static_cast<int>(std::lround(options.duration_s / options.odometry_period_s));
  for (int k = 0; k < samples; ++k) {
    OdometrySample sample;
    sample.from = kStart + from_seconds(k * options.odometry_period_s);
    sample.to = kStart + from_seconds((k + 1) * options.odometry_period_s);
    sample.rates = smooth_rates((k + 0.5) * options.odometry_period_s);
    sample.nominal = world.nominal(sample.rates);
    if (options.is_slipping && random.happens(0.01)) world.slip();
    Timestamp time = sample.from;
    for (; next < feed.frames.size() && feed.frames[next].vision.capture <= sample.to; ++next) {
      world.drive(sample.rates, to_seconds(feed.frames[next].vision.capture - time));
      time = feed.frames[next].vision.capture;
      world.look(feed.frames[next]);
    }
    world.drive(sample.rates, to_seconds(sample.to - time));
    feed.odometry.push_back(sample);
    feed.truth.push_back(world.truth());
  }
  lose_frames(options, random, feed.frames);
  if (options.odometry_gaps > 0.0) lose_odometry(options, random, feed);
  return feed;
}

std::vector<Frame> by_arrival(const Feed& feed) {
  std::vector<Frame> frames = feed.frames;
  std::stable_sort(frames.begin(), frames.end(),
                   [](const Frame& a, const Frame& b) { return a.arrival < b.arrival; });
  return frames;
}

}  // namespace nadir::fusion::test
