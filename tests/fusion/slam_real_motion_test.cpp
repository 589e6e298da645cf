// EkfSlam with two real robots, the first 300 s of UTIAS MR.CLAM 6: one set of parameters for both.

#include <gtest/gtest.h>

#include "tests/fusion/mrclam_slam.h"

namespace nadir::fusion {
namespace {

class RealMapping : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!has_mrclam())
      GTEST_SKIP() << "SKIPPED, LOUDLY: no recordings of real robots in " << mrclam_folder()
                   << "; mapping of real landmarks is NOT checked";
  }
  /// Largest landmark RMSE after rigid alignment.
  static double goal_m() { return GetParam() == 1 ? 0.12 : 0.20; }
};

TEST_P(RealMapping, KnownBarcodesMakeAnHonestMap) {
  const MrclamSlamResult result = run_mrclam_slam(GetParam(), MrclamSlamProtocol{});
  EXPECT_EQ(result.landmarks, result.landmarks_true);
  EXPECT_LT(result.landmark_rmse_m, goal_m());
  EXPECT_GT(result.nees, 2.0);
  EXPECT_LT(result.nees, 6.0);
  EXPECT_GT(result.used, 400);
  EXPECT_LT(result.gated, 5);
}

TEST_P(RealMapping, WithoutBarcodesTheMapIsAtMostHalfAsMuchWorse) {
  MrclamSlamProtocol protocol;
  const double known_m = run_mrclam_slam(GetParam(), protocol).landmark_rmse_m;
  protocol.knows_names = false;
  const MrclamSlamResult result = run_mrclam_slam(GetParam(), protocol);
  EXPECT_LT(result.landmark_rmse_m, 1.5 * known_m);
  EXPECT_LT(result.landmark_rmse_m, 1.5 * goal_m());
  EXPECT_NEAR(result.landmarks, result.landmarks_true, 2);
}

TEST_P(RealMapping, APoseASecondHoldsTheMapInTheWorld) {
  MrclamSlamProtocol protocol;
  protocol.vision_period_s = 1.0;
  const MrclamSlamResult result = run_mrclam_slam(GetParam(), protocol);
  EXPECT_LT(result.pose_rms_m, 0.015);
  EXPECT_LT(result.landmark_world_rmse_m, 0.07);
  EXPECT_GT(result.nees, 1.5);
  EXPECT_LT(result.nees, 6.0);
}

TEST_P(RealMapping, OtherPartsOfTheRecordingAreMappedToo) {
  for (const double start_s : {300.0, 590.0}) {
    MrclamSlamProtocol protocol;
    protocol.start_s = start_s;
    const MrclamSlamResult known = run_mrclam_slam(GetParam(), protocol);
    EXPECT_LT(known.landmark_rmse_m, 0.20) << start_s;
    EXPECT_GT(known.nees, 1.0) << start_s;
    EXPECT_LT(known.nees, 6.0) << start_s;
    protocol.knows_names = false;
    const MrclamSlamResult unknown = run_mrclam_slam(GetParam(), protocol);
    EXPECT_LT(unknown.landmark_rmse_m, 1.7 * known.landmark_rmse_m) << start_s;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RealMapping, testing::Values(1, 2));

}  // namespace
}  // namespace nadir::fusion
