#include <gtest/gtest.h>

#include "fusion/slam/ekf_slam.h"
#include "tests/fusion/dense_slam.h"
#include "tests/fusion/numeric_jacobian.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

using test::DenseSlam;
using test::numeric_jacobian;

PlanarPose pose_of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

TEST(RangeBearing, DerivativesOfASightingAreThoseOfDifferences) {
  test::RandomStream random(1);
  for (int i = 0; i < 50; ++i) {
    Eigen::Matrix<double, 5, 1> at;
    at << random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(4, 9),
        random.uniform(-9, -4);
    const auto seen = [](const Eigen::Matrix<double, 5, 1>& x) -> Eigen::Vector2d {
      return predicted_sighting(pose_of(x.head<3>()), x.tail<2>()).seen.vector();
    };
    const PredictedSighting predicted = predicted_sighting(pose_of(at.head<3>()), at.tail<2>());
    Eigen::Matrix<double, 2, 5> analytic;
    analytic << predicted.by_pose, predicted.by_landmark;
    const Eigen::Matrix<double, 2, 5> numeric = numeric_jacobian<2, 5>(seen, at);
    if ((numeric.row(1).cwiseAbs().maxCoeff()) > 100.0) continue;  // across the wrap
    EXPECT_LT((analytic - numeric).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(RangeBearing, DerivativesOfAPlacedLandmarkAreThoseOfDifferences) {
  const auto place = [](const Eigen::Matrix<double, 5, 1>& x) -> Eigen::Vector2d {
    return placed_landmark(pose_of(x.head<3>()), {x[3], x[4]}).place_m;
  };
  Eigen::Matrix<double, 5, 1> at;
  at << 1.0, -2.0, 0.7, 3.0, -0.4;
  const PlacedLandmark placed = placed_landmark(pose_of(at.head<3>()), {at[3], at[4]});
  Eigen::Matrix<double, 2, 5> analytic;
  analytic << placed.by_pose, placed.by_sighting;
  EXPECT_LT((analytic - numeric_jacobian<2, 5>(place, at)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(RangeBearing, SightingAndPlacingAreInverse) {
  const PlanarPose pose{0.3, -0.8, 3.0};
  const Eigen::Vector2d landmark(-2.0, 1.5);
  const RangeBearing seen = predicted_sighting(pose, landmark).seen;
  EXPECT_LT((placed_landmark(pose, seen).place_m - landmark).norm(), 1e-12);
}

TEST(CameraSensorError, DerivativesAreThoseOfDifferences) {
  const CameraSensorError sensor;
  const auto corrected = [&](const Eigen::Matrix<double, 5, 1>& x) -> Eigen::Vector2d {
    return sensor.corrected({x[3], x[4]}, x.head<3>()).seen.vector();
  };
  Eigen::Matrix<double, 5, 1> at;
  at << 0.05, 0.03, -0.02, 4.0, 0.3;
  const auto here = sensor.corrected({at[3], at[4]}, at.head<3>());
  Eigen::Matrix<double, 2, 5> analytic;
  analytic << here.by_error, here.by_measured;
  EXPECT_LT((analytic - numeric_jacobian<2, 5>(corrected, at)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(EkfSlam, EqualsADenseFilterOfTheTextbook) {
  EkfSlam<>::Settings settings;
  settings.error = ErrorKind::kTextbook;
  settings.sighting_gate = 1e9;
  EkfSlam<> slam(settings);
  const PoseCovariance start = Eigen::Vector3d(1e-4, 1e-4, 1e-3).asDiagonal();
  slam.start({0.0, 0.0, 0.2}, start);
  DenseSlam dense({0.0, 0.0, 0.2}, start);
  test::RandomStream random(3);
  const Eigen::Matrix2d r = sighting_covariance(0.05, 0.02);
  const Eigen::Matrix3d q = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  for (int step = 0; step < 60; ++step) {
    const Eigen::Vector3d by(0.05, 0.02, 0.01);
    slam.move(by, q);
    dense.move(by, q);
    const int landmark = step < 8 ? step : random.whole(0, 7);
    const Eigen::Vector2d place(3.0 + landmark, landmark % 3 - 1.0);
    const Eigen::Vector3d x = dense.x().head<3>();
    const Eigen::Vector2d z = predicted_sighting(pose_of(x), place).seen.vector() +
                              Eigen::Vector2d(0.05 * random.normal(), 0.02 * random.normal());
    const Sighting sighting{{z[0], z[1]}, r, landmark};
    SightingReport report;
    slam.observe({&sighting, 1}, {&report, 1});
    dense.observe(landmark, z, r);
  }
  ASSERT_EQ(slam.landmarks(), 8);
  EXPECT_NEAR(slam.pose().x_m, dense.x()[0], 1e-9);
  EXPECT_NEAR(slam.pose().heading_rad, dense.x()[2], 1e-9);
  EXPECT_LT((slam.pose_covariance() - dense.p().topLeftCorner<3, 3>()).cwiseAbs().maxCoeff(),
            1e-10);
  for (int i = 0; i < 8; ++i) {
    EXPECT_LT((slam.landmark_m(i) - dense.x().segment<2>(3 + 2 * i)).norm(), 1e-9);
    EXPECT_LT((slam.landmark_covariance(i) - dense.p().block<2, 2>(3 + 2 * i, 3 + 2 * i))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-10);
  }
}

TEST(EkfSlam, APoseFromOutsideTurnsTheWholeMapIntoTheWorld) {
  // The start is wrong by a metre and half a radian, and says so; seen from there the landmarks
  // are exact. One exact pose then moves and turns all of it.
  EkfSlam<> slam;
  slam.start({0.0, 0.0, 0.0}, Eigen::Vector3d(1.0, 1.0, 0.25).asDiagonal());
  const PlanarPose truth{1.0, -0.8, 0.5};
  const Eigen::Vector2d places[] = {{4.0, 1.0}, {5.0, -3.0}, {3.0, -6.0}};
  std::vector<Sighting> scan;
  for (int i = 0; i < 3; ++i) {
    scan.push_back({predicted_sighting(truth, places[i]).seen, sighting_covariance(1e-4, 1e-5), i});
  }
  std::vector<SightingReport> reports(3);
  slam.observe(scan, reports);
  EXPECT_GT((slam.landmark_m(2) - places[2]).norm(), 1.0);
  EXPECT_EQ(slam.correct(truth, 1e-10 * PoseCovariance::Identity()).verdict,
            PoseVerdict::kAccepted);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((slam.landmark_m(i) - places[i]).norm(), 1e-3) << i;
    EXPECT_LT(slam.landmark_covariance(i).trace(), 1e-6);
  }
}

TEST(EkfSlam, RefusesWhatMakesNoSenseAndSaysSo) {
  EkfSlam<>::Settings settings;
  settings.most_landmarks = 2;
  EkfSlam<> slam(settings);
  const Eigen::Matrix2d r = sighting_covariance(0.03, 0.002);
  const std::vector<Sighting> scan = {{{std::nan(""), 0.0}, r, 1}, {{-1.0, 0.0}, r, 2},
                                      {{2.0, 0.0}, r, 3},          {{2.0, 1.0}, r, 4},
                                      {{2.0, 2.0}, r, 5},          {{2.0, 0.0}, r, 3}};
  std::vector<SightingReport> reports(scan.size());
  slam.observe(scan, reports);
  EXPECT_EQ(reports[0].verdict, SightingVerdict::kNotFinite);
  EXPECT_EQ(reports[1].verdict, SightingVerdict::kNotFinite);
  EXPECT_EQ(reports[2].verdict, SightingVerdict::kNew);
  EXPECT_EQ(reports[3].verdict, SightingVerdict::kNew);
  EXPECT_EQ(reports[4].verdict, SightingVerdict::kNoRoom);
  EXPECT_EQ(reports[5].verdict, SightingVerdict::kAmbiguous);
  const std::vector<Sighting> wrong = {{{3.0, 0.0}, r, 3}};
  slam.observe(wrong, {reports.data(), 1});
  EXPECT_EQ(reports[0].verdict, SightingVerdict::kGated);
  EXPECT_EQ(slam.landmarks(), 2);
}

}  // namespace
}  // namespace nadir::fusion
