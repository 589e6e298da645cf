// A robot that is carried away finds its place in the map again.

#include <gtest/gtest.h>

#include <vector>

#include "fusion/slam/ekf_slam.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

/// A robot that stands among six landmarks that it knows by name.
class Carried : public testing::Test {
 protected:
  static constexpr double kRange_m = 0.02;
  static constexpr double kBearing_rad = 0.005;

  EkfSlam<> mapped(int lost_after) {
    EkfSlam<>::Settings settings;
    settings.lost_after = lost_after;
    EkfSlam<> slam(settings);
    slam.start(truth_, 1e-8 * PoseCovariance::Identity());
    look(slam, 50, {});
    return slam;
  }

  /// So many scans without moving; `moved` landmarks are seen half a metre too far.
  void look(EkfSlam<>& slam, int scans, const std::vector<int>& moved) {
    const Eigen::Vector2d places[] = {{3.0, 1.0},  {-2.0, 2.5},  {1.0, -3.0},
                                      {4.0, -2.0}, {-3.0, -1.0}, {0.5, 4.0}};
    for (int k = 0; k < scans; ++k) {
      slam.move(Eigen::Vector3d::Zero(), 1e-8 * Eigen::Matrix3d::Identity());
      std::vector<Sighting> scan;
      for (int i = 0; i < 6; ++i) {
        RangeBearing seen = predicted_sighting(truth_, places[i]).seen;
        seen.range_m += kRange_m * random_.normal();
        seen.bearing_rad += kBearing_rad * random_.normal();
        for (const int each : moved) seen.range_m += each == i ? 0.5 : 0.0;
        scan.push_back({seen, sighting_covariance(kRange_m, kBearing_rad), i});
      }
      std::vector<SightingReport> reports(scan.size());
      slam.observe(scan, reports);
    }
  }

  double error_m(const EkfSlam<>& slam) const {
    return (slam.pose().position_m() - truth_.position_m()).norm();
  }

  PlanarPose truth_;
  test::RandomStream random_{5};
};

TEST_F(Carried, FindsItsPlaceAgainWithinTwentyScans) {
  EkfSlam<> slam = mapped(5);
  truth_ = {0.8, -0.5, 0.6};
  look(slam, 20, {});
  EXPECT_GE(slam.recoveries(), 1);
  EXPECT_LT(error_m(slam), 0.03);
  EXPECT_LT(std::abs(wrap_angle(slam.pose().heading_rad - 0.6)), 0.02);
}

TEST_F(Carried, StaysLostWithoutRecovery) {
  EkfSlam<> slam = mapped(0);
  truth_ = {0.8, -0.5, 0.6};
  look(slam, 40, {});
  EXPECT_EQ(slam.recoveries(), 0);
  EXPECT_GT(error_m(slam), 0.5);
}

TEST_F(Carried, DoesNotBelieveFewLandmarksThatMoved) {
  EkfSlam<> slam = mapped(5);
  look(slam, 40, {0, 3});
  EXPECT_EQ(slam.recoveries(), 0);
  EXPECT_LT(error_m(slam), 0.02);
}

}  // namespace
}  // namespace nadir::fusion
