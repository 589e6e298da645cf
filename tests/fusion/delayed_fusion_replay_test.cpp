// The promise of DelayedFusion: whatever the order in which poses come, its history is the one of a
// filter that got them in the order of capture.

#include <gtest/gtest.h>

#include "fusion/delayed_fusion.h"
#include "tests/fusion/in_order_filter.h"
#include "tests/fusion/rate_bias_model.h"

namespace nadir::fusion {
namespace {

using namespace std::chrono_literals;
using test::Feed;
using test::FeedOptions;

FeedOptions random_options(std::uint64_t seed) {
  test::RandomStream random(1000 + seed);
  FeedOptions options;
  options.seed = seed;
  options.duration_s = 3.0;
  options.odometry_period_s = random.happens(0.5) ? 0.02 : 0.005;
  options.frame_period_s = random.happens(0.5) ? 0.04 : 0.02;
  options.captures_between_ticks = random.happens(0.7);
  options.cameras = random.whole(1, 3);
  options.lost = random.uniform(0.0, 0.3);
  options.outliers = random.uniform(0.0, 0.15);
  options.duplicates = random.uniform(0.0, 0.2);
  options.least_delay_s = random.uniform(0.0, 0.06);
  options.most_delay_s = options.least_delay_s + random.uniform(0.0, 0.2);
  options.is_slipping = random.happens(0.6);
  options.odometry_gaps = random.happens(0.3) ? 0.02 : 0.0;
  return options;
}

template <class Fusion>
typename Fusion::Settings random_settings(std::uint64_t seed) {
  test::RandomStream random(5000 + seed);
  typename Fusion::Settings settings;
  settings.filter.gate = random.happens(0.5) ? Gate::chi_square() : Gate::rectangular();
  settings.filter.recovery.poses = random.happens(0.8) ? 5 : 0;
  settings.history.block_length = static_cast<std::size_t>(random.whole(1, 24));
  settings.history.blocks = 1 + 240 / settings.history.block_length;
  settings.history.poses = 300;
  settings.future_tolerance = 50ms;
  return settings;
}

/// How often each thing happened, so that no seed's test is empty.
struct Happened {
  int runs = 0;
  int revised = 0;
  int duplicates = 0;
  int recovered = 0;
  int gated = 0;
  int gaps = 0;
};

template <class Linearization, class OdometryError>
void expect_equal(const typename PoseFilter<Linearization, OdometryError>::State& in_order,
                  const std::optional<Estimate>& replayed) {
  ASSERT_EQ(in_order.has_started, replayed.has_value());
  if (!replayed) return;
  EXPECT_EQ(replayed->pose.x_m, in_order.pose.x_m);
  EXPECT_EQ(replayed->pose.y_m, in_order.pose.y_m);
  EXPECT_EQ(replayed->pose.heading_rad, in_order.pose.heading_rad);
  EXPECT_EQ(replayed->covariance, in_order.pose_covariance());
}

template <class Linearization, class OdometryError>
void compare_with_in_order(std::uint64_t seed, bool starts_known, Happened& happened) {
  using Fusion = DelayedFusion<Linearization, OdometryError>;
  const FeedOptions options = random_options(seed);
  const Feed feed = test::make_feed(options);
  const auto settings = random_settings<Fusion>(seed);
  const auto in_order =
      test::run_in_order<Linearization, OdometryError>(feed, settings.filter, starts_known);
  Fusion fusion(settings);
  if (starts_known) fusion.start(feed.start, feed.expected_start, feed.start_covariance);

  std::map<test::FrameId, PoseVerdict> verdicts;
  std::size_t checked = 0;
  const auto settled = from_seconds(options.most_delay_s + 0.05);
  const std::vector<test::Frame> arrivals = test::by_arrival(feed);
  test::RandomStream again(seed);
  test::feed_live(fusion, feed, [&](std::size_t k) {
    for (const FrameRecord& record : fusion.frames()) {
      verdicts[test::id_of(record.vision_pose())] = record.verdict;
    }
    if (!fusion.frames().empty() && again.happens(options.duplicates)) {
      EXPECT_EQ(fusion.add_pose(fusion.frames().back().vision_pose()).verdict,
                PoseVerdict::kDuplicate);
    }
    for (; checked < k && feed.odometry[checked].to + settled < feed.odometry[k].to; ++checked) {
      expect_equal<Linearization, OdometryError>(in_order.after_sample[checked],
                                                 fusion.estimate_at(feed.odometry[checked].to));
    }
  });
  ASSERT_GT(checked, feed.odometry.size() / 2);

  std::size_t compared = 0;
  for (const test::Frame& frame : feed.frames) {
    if (frame.arrival + settled > feed.odometry.back().to) continue;
    const auto id = test::id_of(frame.vision);
    ASSERT_TRUE(verdicts.contains(id));
    EXPECT_EQ(verdicts.at(id), in_order.verdicts.at(id)) << description(verdicts.at(id));
    ++compared;
  }
  EXPECT_GT(compared, 10U);
  const FusionHealth health = fusion.health();
  ++happened.runs;
  happened.revised += static_cast<int>(health.revised);
  happened.duplicates += static_cast<int>(health.count(PoseVerdict::kDuplicate));
  happened.recovered += static_cast<int>(health.count(PoseVerdict::kRecovered));
  happened.gated += static_cast<int>(health.count(PoseVerdict::kGated));
  happened.gaps += static_cast<int>(health.count(OdometryVerdict::kUsedAfterGap));
}

template <class Linearization, class OdometryError>
void compare_many(std::uint64_t first_seed) {
  Happened happened;
  for (std::uint64_t seed = first_seed; seed < first_seed + 60; ++seed) {
    SCOPED_TRACE(seed);
    compare_with_in_order<Linearization, OdometryError>(seed, seed % 2 == 0, happened);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_EQ(happened.runs, 60);
  EXPECT_GT(happened.revised, 50);
  EXPECT_GT(happened.duplicates, 100);
  EXPECT_GT(happened.recovered, 20);
  EXPECT_GT(happened.gated, 500);
  EXPECT_GT(happened.gaps, 50);
}

TEST(DelayedFusionReplay, EqualsTheOrderOfCaptureAboutTheEstimate) {
  compare_many<AboutEstimate, WhiteOdometryNoise>(1);
}

TEST(DelayedFusionReplay, EqualsTheOrderOfCaptureAlongTheNominal) {
  compare_many<AlongNominal, WhiteOdometryNoise>(101);
}

TEST(DelayedFusionReplay, EqualsTheOrderOfCaptureWithErrorStates) {
  compare_many<AboutEstimate, test::RateBiasModel>(201);
}

TEST(DelayedFusionReplay, OneAtATimeOrTogetherIsTheSame) {
  const Feed feed = test::make_feed(random_options(7));
  DelayedFusion<>::Settings settings;
  settings.history.poses = 300;
  DelayedFusion<> together(settings);
  DelayedFusion<> single(settings);
  const auto frames = test::by_arrival(feed);
  std::size_t next = 0;
  test::feed_live(together, feed, [&](std::size_t k) {
    single.add_odometry(test::odometry_for<DelayedFusion<>>(feed.odometry[k]));
    for (; next < frames.size() && frames[next].arrival <= feed.odometry[k].to; ++next) {
      single.add_pose(frames[next].vision);
    }
    ASSERT_EQ(together.estimate().has_value(), single.estimate().has_value());
    if (!single.estimate()) return;
    EXPECT_EQ(together.estimate()->pose.x_m, single.estimate()->pose.x_m);
    EXPECT_EQ(together.estimate()->covariance, single.estimate()->covariance);
  });
  EXPECT_EQ(together.health().poses, single.health().poses);
}

}  // namespace
}  // namespace nadir::fusion
