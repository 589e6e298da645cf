#pragma once

#include <cstdint>
#include <vector>

#include "fusion/delayed_fusion.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion::test {

/// What happens to a simulated robot and its cameras. The truth is kinematic: smooth measured rates
/// minus noise of the filter's own model, so that covariances can be checked.
struct FeedOptions {
  std::uint64_t seed = 1;
  double duration_s = 6.0;
  double odometry_period_s = 0.02;
  double frame_period_s = 0.04;
  bool captures_between_ticks = true;
  int cameras = 1;
  double lost = 0.0;        ///< share of the frames
  double outliers = 0.0;    ///< share of the frames
  double duplicates = 0.0;  ///< chance of one, each time
  double least_delay_s = 0.06;
  double most_delay_s = 0.10;
  bool is_slipping = false;    ///< jumps of 5 cm and 0.2 rad that odometry does not see
  bool has_rate_bias = false;  ///< noise of RateBiasModel instead of the white one
  double odometry_gaps = 0.0;  ///< share of the odometry that is lost, in runs of some samples
  Eigen::Matrix3d rate_covariance = Eigen::Vector3d(6e-4, 6e-4, 0.0612).asDiagonal();
  PoseCovariance start_covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
};

struct OdometrySample {
  Timestamp from{0};
  Timestamp to{0};
  BodyRates rates;
  AlongNominal::Nominal nominal;
};

struct Frame {
  VisionPose vision;
  Timestamp arrival{0};
  bool is_outlier = false;
};

struct Feed {
  Timestamp start{0};
  PlanarPose expected_start;  ///< the truth's, within the start covariance
  std::vector<OdometrySample> odometry;
  std::vector<PlanarPose> truth;  ///< at the end of each odometry sample
  std::vector<Frame> frames;      ///< in the order of capture
  Eigen::Matrix3d rate_covariance;
  double odometry_period_s = 0.0;
  PoseCovariance start_covariance;
};

Feed make_feed(const FeedOptions& options);

/// The frames in the order of arrival.
std::vector<Frame> by_arrival(const Feed& feed);

/// The sample as a filter with or without a nominal trajectory takes it.
template <class Fusion>
typename Fusion::Odometry odometry_for(const OdometrySample& sample) {
  typename Fusion::Odometry odometry;
  odometry.from = sample.from;
  odometry.to = sample.to;
  odometry.mean_rates = sample.rates;
  if constexpr (requires { odometry.nominal.rates; }) odometry.nominal = sample.nominal;
  return odometry;
}

/// Feeds a fusion in the order in which things come to a robot: all odometry at once, frames at the
/// first odometry after their arrival. `after_each(k)` is called when sample k and the frames that
/// came by then are in.
template <class Fusion, class AfterEach>
void feed_live(Fusion& fusion, const Feed& feed, AfterEach after_each) {
  const std::vector<Frame> frames = by_arrival(feed);
  std::vector<VisionPose> batch;
  std::vector<Correction> results;
  std::size_t next = 0;
  for (std::size_t k = 0; k < feed.odometry.size(); ++k) {
    fusion.add_odometry(odometry_for<Fusion>(feed.odometry[k]));
    batch.clear();
    for (; next < frames.size() && frames[next].arrival <= feed.odometry[k].to; ++next) {
      batch.push_back(frames[next].vision);
    }
    results.resize(batch.size());
    fusion.add_poses(batch, results);
    after_each(k);
  }
}

}  // namespace nadir::fusion::test
