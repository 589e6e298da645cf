// In a program of its own, as it counts every allocation of the process.

#include <gtest/gtest.h>

#include "fusion/odometry_error_body_rates.h"
#include "fusion/slam/ekf_slam.h"
#include "tests/support/allocation_counter.h"

namespace nadir::fusion {
namespace {

TEST(SlamNoAllocation, AfterConstruction) {
  using Slam = EkfSlam<BodyRateError, CameraSensorError>;
  Slam slam;
  slam.start({}, 1e-6 * PoseCovariance::Identity());
  std::array<Sighting, 6> scan;
  std::array<SightingReport, 6> reports;
  const BodyRates rates{0.1, 0.0, 0.3};
  const long before = nadir::test::allocations();
  for (int step = 0; step < 60; ++step) {
    slam.predict({rates, rates, 0.1, 0.1});
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const int name = (step + 3 * static_cast<int>(i)) % 40;
      scan[i] = {{2.0 + 0.1 * name, 0.1 * name - 2.0}, sighting_covariance(0.1, 0.1), name};
    }
    slam.observe(scan, reports);
    slam.observe_nameless(scan, reports);
    slam.correct(slam.pose(), 1e-4 * PoseCovariance::Identity());
  }
  EXPECT_EQ(nadir::test::allocations() - before, 0);
  EXPECT_GT(slam.landmarks(), 20);
}

}  // namespace
}  // namespace nadir::fusion
