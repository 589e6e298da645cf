#include <gtest/gtest.h>

#include "fusion/slam/association.h"
#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {
namespace {

TEST(Association, ChiSquareQuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_99(2), 9.210, 0.01 * 9.210);
  EXPECT_NEAR(chi_square_99(4), 13.277, 0.01 * 13.277);
  EXPECT_NEAR(chi_square_99(16), 32.000, 0.01 * 32.0);
}

/// A row of landmarks 0.3 m apart, seen by a robot whose heading is off by 0.09 rad: at 3 m each
/// looks like its neighbour.
struct Row {
  EkfSlam<> slam;
  std::vector<Sighting> scan;

  explicit Row(AssociationKind kind) : slam(settings(kind)) {
    slam.start({}, 1e-8 * PoseCovariance::Identity());
    scan = seen_from({});
    std::vector<SightingReport> reports(scan.size());
    slam.observe_nameless(scan, reports);
    slam.move(Eigen::Vector3d::Zero(), Eigen::Vector3d(1e-6, 1e-6, 0.0025).asDiagonal());
    scan = seen_from({0.0, 0.0, 0.085});
  }
  static EkfSlam<>::Settings settings(AssociationKind kind) {
    EkfSlam<>::Settings settings;
    settings.association = kind;
    return settings;
  }
  static std::vector<Sighting> seen_from(const PlanarPose& pose) {
    std::vector<Sighting> scan;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d place(3.0, 0.3 * i * (i == 3 ? 1.2 : 1.0));
      scan.push_back({predicted_sighting(pose, place).seen, sighting_covariance(0.01, 0.003), i});
    }
    return scan;
  }
  int wrong() {
    std::vector<SightingReport> reports(scan.size());
    slam.observe_nameless(scan, reports);
    int count = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      count += reports[i].landmark == static_cast<int>(i) ? 0 : 1;
    }
    return count;
  }
};

TEST(Association, JointCompatibilityTellsNeighboursApartThatTheHeadingConfuses) {
  EXPECT_EQ(Row(AssociationKind::kJointCompatibility).wrong(), 0);
  EXPECT_GT(Row(AssociationKind::kNearestNeighbour).wrong(), 0);
}

TEST(Association, AnotherLandmarkBesideOneThatIsSeenTooIsNew) {
  EkfSlam<> slam;
  slam.start({}, 1e-8 * PoseCovariance::Identity());
  const Eigen::Matrix2d r = sighting_covariance(0.05, 0.02);
  std::vector<Sighting> scan = {{{3.0, 0.0}, r, 0}};
  std::vector<SightingReport> reports(2);
  slam.observe_nameless(scan, {reports.data(), 1});
  scan.push_back({{3.0, 0.06}, r, 0});
  slam.observe_nameless(scan, reports);
  EXPECT_EQ(reports[0].verdict, SightingVerdict::kUsed);
  EXPECT_EQ(reports[1].verdict, SightingVerdict::kNew);
  // Alone, and neither surely the one nor surely another: left out.
  scan = {{{3.25, 0.03}, r, 0}};
  slam.observe_nameless(scan, {reports.data(), 1});
  EXPECT_EQ(reports[0].verdict, SightingVerdict::kAmbiguous);
  EXPECT_EQ(slam.landmarks(), 2);
}

TEST(Association, ALandmarkIsGivenOnce) {
  Candidates candidates;
  candidates.covariance.setIdentity();
  candidates.add({0, 7, {0.5, 0.0}, 0.25});
  candidates.add({1, 7, {0.1, 0.0}, 0.01});
  for (const Pairing& pairing :
       {nearest_neighbours(candidates, 2, 9.21), joint_compatibility(candidates, 2, 9.21)}) {
    EXPECT_EQ(pairing[0], -1);
    EXPECT_EQ(pairing[1], 1);
  }
}

}  // namespace
}  // namespace nadir::fusion
