// Whether the covariance is the error's: a robot that drives rounds among landmarks, many times.

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "fusion/odometry.h"
#include "fusion/slam/ekf_slam.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

struct Consistency {
  double nees = 0.0;          ///< of the pose at the end, mean over the runs; expectation 3
  double nis = 0.0;           ///< of the sightings; expectation 2
  double heading_nees = 0.0;  ///< expectation 1
};

/// Three rounds on a circle of 5 m with sensors of 0.05 m and 2 degrees that see 4 m far.
Consistency drive_rounds(ErrorKind error, int runs) {
  constexpr double kStep_s = 0.5;
  const Eigen::Vector3d rate_sigma(0.05, 0.02, 0.08);
  Consistency sum;
  int sightings = 0;
  for (int run = 0; run < runs; ++run) {
    test::RandomStream random(100 + static_cast<std::uint64_t>(run));
    EkfSlam<>::Settings settings;
    settings.error = error;
    settings.sighting_gate = 1e9;
    settings.odometry_error = WhiteOdometryNoise(rate_sigma.cwiseAbs2().asDiagonal(), kStep_s);
    EkfSlam<> slam(settings);
    PlanarPose truth{5.0, 0.0, 1.5707963267948966};
    slam.start(truth, 1e-10 * PoseCovariance::Identity());
    const BodyRates rates{0.5, 0.0, 0.1};
    for (int step = 0; step < 376; ++step) {
      truth = moved(truth, rates, kStep_s);
      const BodyRates measured =
          BodyRates::from(rates.vector() + Eigen::Vector3d(rate_sigma.x() * random.normal(),
                                                           rate_sigma.y() * random.normal(),
                                                           rate_sigma.z() * random.normal()));
      slam.predict({measured, measured, kStep_s, kStep_s});
      std::vector<Sighting> scan;
      for (int i = 0; i < 24; ++i) {
        const double angle = 0.2617993877991494 * i;
        const double radius = i % 2 == 0 ? 4.0 : 6.5;
        RangeBearing seen =
            predicted_sighting(truth, {radius * std::cos(angle), radius * std::sin(angle)}).seen;
        if (seen.range_m > 4.0) continue;
        seen.range_m += 0.05 * random.normal();
        seen.bearing_rad += 0.035 * random.normal();
        scan.push_back({seen, sighting_covariance(0.05, 0.035), i});
      }
      std::vector<SightingReport> reports(scan.size());
      slam.observe(scan, reports);
      for (const SightingReport& report : reports) {
        if (report.verdict != SightingVerdict::kUsed) continue;
        sum.nis += report.nis;
        ++sightings;
      }
    }
    const Eigen::Vector3d e = pose_difference(slam.pose(), truth);
    sum.nees += e.dot(slam.pose_covariance().inverse() * e);
    sum.heading_nees += e.z() * e.z() / slam.pose_covariance()(2, 2);
  }
  return {sum.nees / runs, sum.nis / sightings, sum.heading_nees / runs};
}

TEST(SlamConsistency, TheInvariantErrorKeepsNeesInItsBand) {
  constexpr int kRuns = 40;  // 95 %: chi-square with 120 degrees of freedom, over 40
  const Consistency invariant = drive_rounds(ErrorKind::kInvariant, kRuns);
  EXPECT_GT(invariant.nees, 2.289);
  EXPECT_LT(invariant.nees, 3.805);
  EXPECT_NEAR(invariant.nis, 2.0, 0.1);
}

TEST(SlamConsistency, TheTextbooksErrorBecomesTooSureOfItsHeading) {
  constexpr int kRuns = 40;
  const Consistency textbook = drive_rounds(ErrorKind::kTextbook, kRuns);
  const Consistency invariant = drive_rounds(ErrorKind::kInvariant, kRuns);
  EXPECT_GT(textbook.nees, 1.2 * invariant.nees);
  EXPECT_GT(textbook.heading_nees, 2.0);  // invariant: 0.9
  EXPECT_LT(invariant.heading_nees, 1.5);
}

}  // namespace
}  // namespace nadir::fusion
