// Whether the covariance tells the truth (theory 3.3), and how far from the best possible the
// estimate is (theory 3.4), by Monte Carlo with noise that is the filter's own.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <set>

#include "fusion/delayed_fusion.h"
#include "fusion/wheel_geometry.h"
#include "tests/fusion/in_order_filter.h"
#include "tests/fusion/rate_bias_model.h"

namespace nadir::fusion {
namespace {

using test::Feed;
using test::FeedOptions;

double nees(const Estimate& estimate, const PlanarPose& truth) {
  const Eigen::Vector3d error = pose_difference(estimate.pose, truth);
  return error.dot(estimate.covariance.inverse() * error);
}

// 0.999 bounds of a chi-square variable with so many degrees of freedom (Wilson and Hilferty).
double chi_square_bound(double degrees, double standard_normal) {
  const double share = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - share + standard_normal * std::sqrt(share), 3);
}
void expect_chi_square_mean(double mean, int samples, double standard_normal) {
  const double degrees = 3.0 * samples;
  EXPECT_GT(mean, chi_square_bound(degrees, -standard_normal) / samples);
  EXPECT_LT(mean, chi_square_bound(degrees, standard_normal) / samples);
}
constexpr double kWithin999 = 3.29;

/// The mean NEES of 100 runs at each of the seconds, and of all.
template <class Linearization, class OdometryError>
void expect_consistent(FeedOptions options, OdometryError odometry_error) {
  constexpr int kRuns = 100;
  constexpr int kSeconds = 6;
  using Fusion = DelayedFusion<Linearization, OdometryError>;
  typename Fusion::Settings settings;
  settings.filter.odometry_error = odometry_error;
  settings.future_tolerance = std::chrono::milliseconds(40);
  std::array<double, kSeconds> sum = {};
  for (int run = 0; run < kRuns; ++run) {
    options.seed = static_cast<std::uint64_t>(4000 + run);
    options.duration_s = kSeconds;
    const Feed feed = test::make_feed(options);
    Fusion fusion(settings);
    fusion.start(feed.start, feed.expected_start, feed.start_covariance);
    const auto samples_per_second = static_cast<std::size_t>(1.0 / options.odometry_period_s);
    test::feed_live(fusion, feed, [&](std::size_t k) {
      if ((k + 1) % samples_per_second != 0) return;
      sum.at((k + 1) / samples_per_second - 1) += nees(*fusion.estimate(), feed.truth[k]);
    });
  }
  double all = 0.0;
  for (const double each : sum) {
    expect_chi_square_mean(each / kRuns, kRuns, kWithin999);
    all += each / (kRuns * kSeconds);
  }
  expect_chi_square_mean(all, kRuns * kSeconds, kWithin999);
}

FeedOptions late_and_lossy() {
  FeedOptions options;
  options.lost = 0.1;
  options.outliers = 0.05;
  return options;
}

TEST(Consistency, NeesAboutTheEstimate) {
  const FeedOptions options = late_and_lossy();
  expect_consistent<AboutEstimate>(options, WhiteOdometryNoise(options.rate_covariance, 0.02));
}

TEST(Consistency, NeesAlongTheNominal) {
  const FeedOptions options = late_and_lossy();
  expect_consistent<AlongNominal>(options, WhiteOdometryNoise(options.rate_covariance, 0.02));
}

TEST(Consistency, NeesAt200HertzWithThreeCameras) {
  FeedOptions options = late_and_lossy();
  options.odometry_period_s = 0.005;
  options.cameras = 3;
  expect_consistent<AboutEstimate>(options, WhiteOdometryNoise(options.rate_covariance, 0.005));
}

TEST(Consistency, NeesWithErrorStates) {
  FeedOptions options = late_and_lossy();
  options.has_rate_bias = true;
  expect_consistent<AboutEstimate>(options, test::RateBiasModel{});
}

TEST(Consistency, NeesWhenTheFirstPoseStarts) {
  constexpr int kRuns = 300;
  double sum = 0.0;
  int counted = 0;
  for (int run = 0; run < kRuns; ++run) {
    FeedOptions options;
    options.seed = static_cast<std::uint64_t>(6000 + run);
    options.duration_s = 0.4;
    const Feed feed = test::make_feed(options);
    DelayedFusion<> fusion;
    test::feed_live(fusion, feed, [](std::size_t) {});
    if (!fusion.estimate()) continue;
    sum += nees(*fusion.estimate(), feed.truth.back());
    ++counted;
  }
  ASSERT_EQ(counted, kRuns);
  expect_chi_square_mean(sum / kRuns, kRuns, kWithin999);
}

TEST(Consistency, NeesGrowsWhereTheModelIsWrong) {
  // The test above can fail: a filter that trusts odometry too much is found out.
  FeedOptions options = late_and_lossy();
  options.seed = 9;
  options.duration_s = 20.0;
  const Feed feed = test::make_feed(options);
  DelayedFusion<>::Settings settings;
  settings.filter.odometry_error = WhiteOdometryNoise(options.rate_covariance / 9.0, 0.02);
  DelayedFusion<> fusion(settings);
  fusion.start(feed.start, feed.expected_start, feed.start_covariance);
  double sum = 0.0;
  test::feed_live(fusion, feed,
                  [&](std::size_t k) { sum += nees(*fusion.estimate(), feed.truth[k]); });
  EXPECT_GT(sum / static_cast<double>(feed.odometry.size()), 5.0);
}

TEST(Consistency, InnovationsAreAsLargeAsPromisedAndWhite) {
  FeedOptions options;
  options.duration_s = 300.0;
  const Feed feed = test::make_feed(options);
  PoseFilter<>::Settings settings;
  settings.gate = Gate::none();
  settings.odometry_error = WhiteOdometryNoise(options.rate_covariance, 0.02);
  PoseFilter<> filter(settings);
  filter.start(feed.expected_start, feed.start_covariance);
  double nis = 0.0;
  Eigen::Vector3d correlation = Eigen::Vector3d::Zero();
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  std::size_t next = 0;
  for (const test::OdometrySample& sample : feed.odometry) {
    Timestamp time = sample.from;
    const auto predict_until = [&](Timestamp to) {
      if (to > time) filter.predict({sample.rates, sample.rates, 0.02, to_seconds(to - time)});
      time = to;
    };
    for (; next < feed.frames.size() && feed.frames[next].vision.capture <= sample.to; ++next) {
      const VisionPose& vision = feed.frames[next].vision;
      predict_until(vision.capture);
      const Correction c = filter.correct(vision.pose, vision.covariance);
      nis += c.nis;
      const Eigen::Vector3d now =
          c.innovation.cwiseQuotient(c.innovation_covariance.diagonal().cwiseSqrt());
      correlation += now.cwiseProduct(before);
      before = now;
    }
    predict_until(sample.to);
  }
  const auto frames = static_cast<double>(feed.frames.size());
  expect_chi_square_mean(nis / frames, static_cast<int>(frames), kWithin999);
  EXPECT_LT((correlation / frames).cwiseAbs().maxCoeff(), kWithin999 / std::sqrt(frames));
}

// The posterior Cramer-Rao bound after sample `last`: the covariance recursion at the true
// trajectory, with the good frames that had come by then, in information form.
Eigen::Matrix3d bound(const Feed& feed, std::size_t last) {
  Eigen::Matrix3d p = feed.start_covariance;
  std::size_t next = 0;
  double heading_rad = feed.expected_start.heading_rad;
  const double dt_s = feed.odometry_period_s;
  for (std::size_t k = 0; k <= last; ++k) {
    const Eigen::Vector3d q = feed.odometry[k].rates.vector();
    const double c = std::cos(heading_rad + 0.5 * q[2] * dt_s);
    const double s = std::sin(heading_rad + 0.5 * q[2] * dt_s);
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
    a(0, 2) = -dt_s * (s * q[0] + c * q[1]);
    a(1, 2) = dt_s * (c * q[0] - s * q[1]);
    Eigen::Matrix3d w;
    w << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
    p = a * p * a.transpose() + dt_s * dt_s * w * feed.rate_covariance * w.transpose();
    for (; next < feed.frames.size() && feed.frames[next].vision.capture <= feed.odometry[k].to;
         ++next) {
      const test::Frame& frame = feed.frames[next];
      if (frame.is_outlier || frame.arrival > feed.odometry[last].to) continue;
      p = (p.inverse() + frame.vision.covariance.inverse()).inverse();
    }
    heading_rad = feed.truth[k].heading_rad;
  }
  return p;
}

struct MatchedCase {
  double rms_m = 0.0;
  double bound_m = 0.0;
  int outliers = 0;
  int outliers_used = 0;
  double rejected_share = 0.0;
};

template <class Linearization>
MatchedCase run_matched_case(double frame_period_s) {
  MatchedCase result;
  double samples = 0.0;
  double inliers = 0.0;
  double rejected = 0.0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    FeedOptions options = late_and_lossy();
    options.seed = seed;
    options.frame_period_s = frame_period_s;
    options.captures_between_ticks = false;
    options.rate_covariance = WheelGeometry::three_wheel(0.07).rate_covariance(0.02);
    const Feed feed = test::make_feed(options);
    typename DelayedFusion<Linearization>::Settings settings;
    settings.filter.gate = Gate::rectangular();
    settings.filter.odometry_error = WhiteOdometryNoise(options.rate_covariance, 0.02);
    settings.history.poses = 400;
    settings.history.blocks = 40;  // all of it: the verdicts are read at the end
    DelayedFusion<Linearization> fusion(settings);
    fusion.start(feed.start, feed.expected_start, feed.start_covariance);
    test::feed_live(fusion, feed, [&](std::size_t k) {
      if (k < 50 || k % 10 != 0) return;
      const Eigen::Vector3d error = pose_difference(fusion.estimate()->pose, feed.truth[k]);
      result.rms_m += error.head<2>().squaredNorm();
      result.bound_m += bound(feed, k).topLeftCorner<2, 2>().trace();
      samples += 1.0;
    });
    std::set<test::FrameId> outliers;
    for (const test::Frame& frame : feed.frames) {
      if (frame.is_outlier) outliers.insert(test::id_of(frame.vision));
    }
    for (const FrameRecord& record : fusion.frames()) {
      const bool is_outlier = outliers.contains(test::id_of(record.vision_pose()));
      result.outliers += is_outlier ? 1 : 0;
      result.outliers_used += is_outlier && is_used(record.verdict) ? 1 : 0;
      inliers += is_outlier ? 0.0 : 1.0;
      rejected += !is_outlier && record.verdict == PoseVerdict::kGated ? 1.0 : 0.0;
    }
  }
  result.rms_m = std::sqrt(result.rms_m / samples);
  result.bound_m = std::sqrt(result.bound_m / samples);
  result.rejected_share = rejected / inliers;
  return result;
}

template <class Linearization>
void expect_near_the_bound() {
  for (const double frame_period_s : {0.04, 0.02}) {
    const MatchedCase result = run_matched_case<Linearization>(frame_period_s);
    SCOPED_TRACE(::testing::Message() << frame_period_s << " s: rms " << result.rms_m
                                      << " m, bound " << result.bound_m << " m");
    EXPECT_LE(result.rms_m, 1.03 * result.bound_m + 5e-5);
    EXPECT_GE(result.rms_m, 0.95 * result.bound_m) << "better than possible: the test is wrong";
    EXPECT_GT(result.outliers, 500);
    EXPECT_EQ(result.outliers_used, 0);
    EXPECT_GT(result.rejected_share, 0.006);
    EXPECT_LT(result.rejected_share, 0.011);
  }
}

TEST(CramerRaoBound, IsReachedAboutTheEstimate) { expect_near_the_bound<AboutEstimate>(); }
TEST(CramerRaoBound, IsReachedAlongTheNominal) { expect_near_the_bound<AlongNominal>(); }

}  // namespace
}  // namespace nadir::fusion
