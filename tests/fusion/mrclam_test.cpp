// Two real robots, 900 s each, whose odometry is commanded velocities, through nadir-fuse's own
// functions with default settings. The recordings are not part of nadir: without them, skipped.

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/fuse/fuse_run.h"
#include "fusion/fuse/fuse_score.h"
#include "fusion/time_offset_estimator.h"
#include "tests/fusion/mrclam_feed.h"

namespace nadir::fusion {
namespace {

/// Robot 1 or 2.
class RealMotion : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!has_mrclam()) {
      GTEST_SKIP() << "SKIPPED, LOUDLY: no recordings of real robots in " << mrclam_folder()
                   << "; errors on real motion are NOT checked";
    }
  }

  static FuseRun run(const MrclamFeed& feed, const FuseConfig& config = {},
                     FilterKind kind = FilterKind::kEkf) {
    return fuse({feed.odometry, feed.vision, {}}, config, kind);
  }
  static FuseScore errors(const MrclamProtocol& protocol, const FuseConfig& config = {},
                          FilterKind kind = FilterKind::kEkf) {
    const MrclamFeed feed = load_mrclam(GetParam(), protocol);
    const FuseScore result = score(run(feed, config, kind).estimates, TruthLine(feed.truth));
    RecordProperty("position_rms_um", static_cast<int>(result.position_rms_m * 1e6));
    RecordProperty("nees_percent", static_cast<int>(result.nees * 100));
    EXPECT_GT(result.compared, 40000U);
    return result;
  }
  static void expect_honest(const FuseScore& score) {
    EXPECT_GT(score.nees, 2.0);
    EXPECT_LT(score.nees, 4.5);
  }
};

TEST_P(RealMotion, FiftyMillisecondsLate) {
  MrclamProtocol protocol;
  protocol.delay_s = 0.05;
  const FuseScore score = errors(protocol);
  EXPECT_LT(score.position_rms_m, 0.0053);
  expect_honest(score);
}

TEST_P(RealMotion, HundredFiftyMillisecondsLate) {
  MrclamProtocol protocol;
  protocol.delay_s = 0.15;
  for (const FilterKind kind : {FilterKind::kEkf, FilterKind::kNominal}) {
    const FuseScore score = errors(protocol, {}, kind);
    EXPECT_LT(score.position_rms_m, 0.0058);
    expect_honest(score);
  }
}

TEST_P(RealMotion, TwoSecondsOfEveryTwentyWithoutFrames) {
  MrclamProtocol protocol;
  protocol.delay_s = 0.1;
  protocol.drop_s = 2.0;
  const FuseScore score = errors(protocol);
  EXPECT_LT(score.position_rms_m, 0.0075);
  expect_honest(score);
}

TEST_P(RealMotion, LeadOfTheCommandsIsFoundAndHelps) {
  MrclamProtocol protocol;
  protocol.delay_s = 0.15;
  const FuseRun with_default = run(load_mrclam(GetParam(), protocol));
  ASSERT_TRUE(with_default.lag);
  EXPECT_NEAR(with_default.lag->lag_s, 0.2, 0.03);  // 180 to 220 ms
  EXPECT_LT(with_default.lag->sigma_s, 0.02);
  FuseConfig config;
  config.odometry_lead_s = with_default.lag->lag_s;
  const FuseScore score = errors(protocol, config);
  EXPECT_LT(score.position_rms_m, 0.0050);
  EXPECT_LT(score.heading_rms_rad, 0.85 * errors(protocol).heading_rms_rad);
  // Nothing is left then.
  const FuseRun with_lead = run(load_mrclam(GetParam(), protocol), config);
  ASSERT_TRUE(with_lead.lag);
  EXPECT_NEAR(with_lead.lag->lag_s, 0.0, 0.015);
}

TEST_P(RealMotion, DelayDeclaredWrongBySixtyMillisecondsIsFound) {
  MrclamProtocol protocol;
  protocol.delay_s = 0.15;
  FuseConfig config;
  config.odometry_lead_s = run(load_mrclam(GetParam(), protocol)).lag->lag_s;
  for (const double wrong_s : {-0.06, 0.06}) {
    protocol.undeclared_delay_s = wrong_s;
    protocol.seed = 2;  // not the noise that the lead was found with
    const FuseRun result = run(load_mrclam(GetParam(), protocol), config);
    ASSERT_TRUE(result.lag);
    EXPECT_NEAR(result.lag->lag_s, wrong_s, 0.015);
    // Declared rightly, the error is that of an honest log again.
    config.vision_undeclared_delay_s = result.lag->lag_s;
    EXPECT_LT(errors(protocol, config).position_rms_m, 0.0055);
    config.vision_undeclared_delay_s = 0.0;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RealMotion, testing::Values(1, 2));

}  // namespace
}  // namespace nadir::fusion
