// In a program of its own, as it counts every allocation of the process.

#include <gtest/gtest.h>

#include "fusion/delayed_fusion.h"
#include "tests/fusion/fusion_feed.h"
#include "tests/fusion/rate_bias_model.h"
#include "tests/support/allocation_counter.h"

namespace nadir::fusion {
namespace {

template <class Fusion>
void expect_no_allocation() {
  test::FeedOptions options;
  options.cameras = 2;
  options.outliers = 0.1;
  options.most_delay_s = 0.2;
  options.is_slipping = true;
  options.odometry_gaps = 0.02;
  const test::Feed feed = test::make_feed(options);
  const std::vector<test::Frame> frames = test::by_arrival(feed);
  Fusion fusion;
  std::size_t next = 0;
  int used = 0;
  double sum = 0.0;
  const long before = nadir::test::allocations();
  for (const test::OdometrySample& sample : feed.odometry) {
    fusion.add_odometry(test::odometry_for<Fusion>(sample));
    for (; next < frames.size() && frames[next].arrival <= sample.to; ++next) {
      used += is_used(fusion.add_pose(frames[next].vision).verdict) ? 1 : 0;
      fusion.add_pose(frames[next].vision);  // a duplicate
    }
    if (fusion.estimate())
      sum += fusion.estimate_at(fusion.now() - from_seconds(0.1)).value_or(Estimate{}).pose.x_m;
    sum += fusion.health().nis_mean;
  }
  EXPECT_EQ(nadir::test::allocations() - before, 0) << sum;
  EXPECT_GT(used, 100);
}

TEST(NoAllocation, CounterCounts) {
  const long before = nadir::test::allocations();
  const std::vector<int> numbers(100);
  EXPECT_EQ(nadir::test::allocations() - before, 1) << numbers.size();
}

TEST(NoAllocation, AfterConstructionAboutTheEstimate) {
  expect_no_allocation<DelayedFusion<AboutEstimate>>();
}
TEST(NoAllocation, AfterConstructionAlongTheNominal) {
  expect_no_allocation<DelayedFusion<AlongNominal>>();
}
TEST(NoAllocation, AfterConstructionWithErrorStates) {
  expect_no_allocation<DelayedFusion<AboutEstimate, test::RateBiasModel>>();
}

}  // namespace
}  // namespace nadir::fusion
