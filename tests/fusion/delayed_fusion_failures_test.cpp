// What goes wrong in the field, and what the fusion makes of it: each input has the expected
// verdict, and a second after the last bad one the estimate is right and knows how right it is.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "fusion/delayed_fusion.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

using namespace std::chrono_literals;

/// A robot that drives in circles with 100 Hz odometry, seen at 25 Hz, 80 ms late. Time, truth and
/// the fusion go on together; a test disturbs what it wants to.
class DisturbedRun : public ::testing::Test {
 protected:
  DisturbedRun() {
    fusion_.start(now_, truth_, covariance_);
    run_for(1s);
    EXPECT_EQ(health().count(PoseVerdict::kGated), 0U);
  }

  FusionHealth health() const { return fusion_.health(); }

  /// One tick: truth, odometry, and the frames that are due.
  void tick(bool has_odometry = true, bool has_vision = true) {
    const Eigen::Vector3d noise = random_.normal(Eigen::Matrix3d(2.0 * rate_covariance_));
    const Timestamp from = now_;
    now_ += 10ms;
    truth_ = moved(truth_, BodyRates::from(rates_.vector() - noise), 0.01);
    if (has_odometry) {
      last_odometry_ = fusion_.add_odometry({from + clock_, now_ + clock_, rates_, {}});
    }
    if (now_.count() % (40ms / 1ns) == 0 && has_vision) seen_[frame_ % seen_.size()] = frame();
    const VisionPose& due = seen_[(frame_ + seen_.size() - 2) % seen_.size()];
    if (due.capture + 80ms == now_ + clock_) last_ = fusion_.add_pose(due).verdict;
  }

  void run_for(std::chrono::nanoseconds span, bool has_odometry = true, bool has_vision = true) {
    for (const Timestamp end = now_ + span; now_ < end;) tick(has_odometry, has_vision);
  }

  /// A good frame of now.
  VisionPose frame() {
    const Eigen::Vector3d noise = random_.normal(covariance_);
    return {0,
            0,
            ++frame_,
            now_ + clock_,
            {truth_.x_m + offset_m_ + noise.x(), truth_.y_m + noise.y(),
             truth_.heading_rad + noise.z()},
            covariance_};
  }

  /// One second later the estimate is right by its own covariance (0.9999 of chi-square 3) and as
  /// precise as ever.
  void expect_consistent_after_a_second() {
    run_for(1s);
    expect_consistent();
  }
  void expect_consistent() {
    const auto estimate = fusion_.estimate();
    ASSERT_TRUE(estimate);
    PlanarPose shown = truth_;
    shown.x_m += offset_m_;
    const Eigen::Vector3d error = pose_difference(estimate->pose, shown);
    EXPECT_LT(error.dot(estimate->covariance.inverse() * error), 21.1);
    EXPECT_LT(std::sqrt(estimate->covariance(0, 0)), 0.004);
    EXPECT_EQ(fusion_.now(), now_ + clock_);
    EXPECT_LT(*health().age_of_last_used, 200ms);
  }

  std::uint64_t count(PoseVerdict verdict) const { return health().count(verdict); }

  const Eigen::Matrix3d rate_covariance_ = Eigen::Vector3d(6e-4, 6e-4, 0.0612).asDiagonal();
  const PoseCovariance covariance_ = Eigen::Vector3d(2e-6, 2e-6, 1e-3).asDiagonal();
  const BodyRates rates_{0.3, 0.0, 0.5};
  test::RandomStream random_{77};
  Timestamp now_ = 1000s;
  std::chrono::nanoseconds clock_ = 0ns;  ///< what the stamps are off
  double offset_m_ = 0.0;                 ///< of the camera's calibration
  PlanarPose truth_{0.3, 0.2, 1.0};
  std::uint64_t frame_ = 0;
  std::array<VisionPose, 8> seen_;
  PoseVerdict last_ = PoseVerdict::kAccepted;
  OdometryVerdict last_odometry_ = OdometryVerdict::kUsed;
  DelayedFusion<> fusion_;
};

TEST_F(DisturbedRun, NothingComesForThirtySeconds) {
  run_for(30s, false, false);
  EXPECT_EQ(*health().age_of_last_used, 80ms) << "its own time stands still";
  tick();
  EXPECT_EQ(last_odometry_, OdometryVerdict::kUsedAfterGap);
  EXPECT_GT(fusion_.estimate()->covariance(0, 0), 100.0);
  expect_consistent_after_a_second();
  EXPECT_EQ(count(PoseVerdict::kGated), 0U) << "after such a gap every place is believed";
}

TEST_F(DisturbedRun, NoPosesForThirtySeconds) {
  const double before = fusion_.estimate()->covariance(0, 0);
  run_for(30s, true, false);
  EXPECT_GT(*health().age_of_last_used, 30s);
  EXPECT_GT(fusion_.estimate()->covariance(0, 0), 100.0 * before);
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, NumbersThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  VisionPose bad = frame();
  bad.pose.heading_rad = nan;
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kNotFinite);
  bad = frame();
  bad.covariance(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kNotFinite);
  EXPECT_EQ(fusion_.add_odometry({now_, now_ + 10ms, {nan, 0.0, 0.0}, {}}),
            OdometryVerdict::kNotFinite);
  EXPECT_EQ(count(PoseVerdict::kNotFinite), 2U);
  EXPECT_EQ(health().count(OdometryVerdict::kNotFinite), 1U);
  expect_consistent_after_a_second();
  EXPECT_EQ(health().count(OdometryVerdict::kUsedAfterGap), 0U);
}

TEST_F(DisturbedRun, StampsThatNobodySet) {
  VisionPose bad = frame();
  bad.capture = 0ns;
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kZeroStamp);
  EXPECT_EQ(fusion_.add_odometry({0ns, 10ms, rates_, {}}), OdometryVerdict::kZeroStamp);
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, AStampJumpsBack) {
  VisionPose bad = frame();
  bad.capture -= 20s;
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kTooOld);
  EXPECT_EQ(fusion_.add_odometry({now_ - 20s, now_ - 20s + 10ms, rates_, {}}),
            OdometryVerdict::kBehind);
  expect_consistent_after_a_second();
  EXPECT_EQ(count(PoseVerdict::kTooOld), 1U);
}

TEST_F(DisturbedRun, AStampJumpsAhead) {
  VisionPose bad = frame();
  bad.capture += 20s;
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kFromTheFuture);
  EXPECT_EQ(fusion_.add_odometry({now_ + 3600s, now_ + 3600s + 10ms, rates_, {}}),
            OdometryVerdict::kAhead);
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, AJumpAheadThatIsBelievedIsFoundOut) {
  // 20 s could be a gap. The samples after it are behind then, until they are too many.
  EXPECT_EQ(fusion_.add_odometry({now_ + 20s, now_ + 20s + 10ms, rates_, {}}),
            OdometryVerdict::kUsedAfterGap);
  expect_consistent_after_a_second();
  EXPECT_EQ(health().count(OdometryVerdict::kClockRestarted), 1U);
}

TEST_F(DisturbedRun, TheClockIsSetBackForGood) {
  clock_ = -100s;
  run_for(100ms);
  EXPECT_EQ(last_odometry_, OdometryVerdict::kClockRestarted);
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, StampsJitterByAMillisecond) {
  // Of odometry, each end for itself, and of the captures: 0.3 mm and 0.5 mrad of motion.
  for (int i = 0; i < 300; ++i) {
    const auto jitter = [&] { return from_seconds(random_.uniform(-1e-3, 1e-3)); };
    const Timestamp from = now_;
    now_ += 10ms;
    truth_ = moved(truth_, rates_, 0.01);
    last_odometry_ = fusion_.add_odometry({from + jitter(), now_ + jitter(), rates_, {}});
    EXPECT_EQ(last_odometry_, OdometryVerdict::kUsed);
    if (i % 4 == 0) {
      VisionPose pose = frame();
      pose.capture += jitter() - 2ms;
      pose.pose = {pose.pose.x_m - 0.002 * 0.3 * std::cos(truth_.heading_rad),
                   pose.pose.y_m - 0.002 * 0.3 * std::sin(truth_.heading_rad),
                   pose.pose.heading_rad - 0.002 * 0.5};
      EXPECT_TRUE(is_used(fusion_.add_pose(pose).verdict));
    }
  }
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, FramesComeTwice) {
  const auto estimate = fusion_.estimate();
  const std::uint64_t accepted = count(PoseVerdict::kAccepted);
  std::vector<VisionPose> again;
  for (const FrameRecord& record : fusion_.frames()) again.push_back(record.vision_pose());
  for (const VisionPose& pose : again) {
    EXPECT_EQ(fusion_.add_pose(pose).verdict, PoseVerdict::kDuplicate);
  }
  EXPECT_EQ(count(PoseVerdict::kDuplicate), again.size());
  EXPECT_EQ(count(PoseVerdict::kAccepted), accepted);
  EXPECT_EQ(fusion_.estimate()->covariance, estimate->covariance) << "known twice is known once";
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, ARestartedTrackerCountsFromTheBeginning) {
  const std::uint64_t used = frame_;
  VisionPose pose = frame();
  pose.frame = used;
  pose.epoch = 1;
  EXPECT_TRUE(is_used(fusion_.add_pose(pose).verdict));
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, CovariancesThatAreNone) {
  VisionPose bad = frame();
  bad.covariance(0, 0) = -bad.covariance(0, 0);
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kCovarianceNotPositive);
  bad = frame();
  bad.covariance = PoseCovariance::Zero();
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kCovarianceNotPositive);
  bad = frame();
  bad.covariance(0, 2) = 1e-5;
  EXPECT_EQ(fusion_.add_pose(bad).verdict, PoseVerdict::kCovarianceNotSymmetric);
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, EveryTwentiethFrameLies) {
  int lies = 0;
  for (int i = 0; i < 2000; ++i) {
    tick();
    if (i % 80 != 0) continue;
    VisionPose lie = frame();
    lie.camera = 3;
    lie.pose = {random_.uniform(-0.75, 0.75), random_.uniform(-0.75, 0.75),
                random_.uniform(-3.0, 3.0)};
    ++lies;
    EXPECT_EQ(fusion_.add_pose(lie).verdict, PoseVerdict::kGated);
  }
  EXPECT_EQ(lies, 25);
  EXPECT_EQ(count(PoseVerdict::kRecovered) + count(PoseVerdict::kReset), 0U);
  expect_consistent_after_a_second();
}

TEST_F(DisturbedRun, TheNextCameraDisagreesByThirtyMillimetres) {
  offset_m_ = 0.03;
  expect_consistent_after_a_second();
  EXPECT_GE(count(PoseVerdict::kRecovered), 1U);
  EXPECT_LE(count(PoseVerdict::kGated), 6U);
  EXPECT_EQ(count(PoseVerdict::kReset), 0U);
}

TEST_F(DisturbedRun, TheRobotIsCarriedAway) {
  // Two seconds in the hand: the wheels stand, the cameras see it fly.
  const PlanarPose from = truth_;
  for (int i = 1; i <= 200; ++i) {
    const double share = i / 200.0;
    const Timestamp start = now_;
    now_ += 10ms;
    truth_ = {from.x_m + 1.2 * share, from.y_m - 0.8 * share,
              wrap_angle(from.heading_rad + 2.0 * share)};
    fusion_.add_odometry({start + clock_, now_ + clock_, {}, {}});
    if (i % 4 == 0) fusion_.add_pose(frame());
  }
  expect_consistent_after_a_second();
  EXPECT_GE(count(PoseVerdict::kReset) + count(PoseVerdict::kRecovered), 1U);
}

TEST_F(DisturbedRun, TheRobotIsPutElsewhereUnseen) {
  truth_ = {-1.0, 0.7, -2.0};
  expect_consistent_after_a_second();
  EXPECT_EQ(count(PoseVerdict::kReset), 1U);
}

}  // namespace
}  // namespace nadir::fusion
