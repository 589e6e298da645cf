#include "tracker/evaluation/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tracker/evaluation/error_statistics.h"

namespace nadir::tracker {
namespace {

LoggedRobot robot(int id, const std::string& team, double x_m, double y_m,
                  double heading_rad = 0.0) {
  LoggedRobot robot;
  robot.id = id;
  robot.team = team;
  robot.pose_world_robot = {x_m, y_m, heading_rad};
  robot.covariance = fusion::PoseCovariance::Identity();
  return robot;
}

LoggedFrame frame(std::uint64_t number, std::vector<LoggedRobot> robots) {
  LoggedFrame frame;
  frame.frame = number;
  frame.robots = std::move(robots);
  return frame;
}

TEST(Evaluation, PairsByNameThoughAnotherRobotIsNearer) {
  const Evaluation result =
      evaluate({frame(0, {robot(1, "blue", 0.0, 0.0), robot(2, "blue", 0.06, 0.0)})},
               {frame(0, {robot(1, "blue", 0.04, 0.0), robot(2, "blue", 0.06, 0.01)})});
  EXPECT_EQ(result.found, 2U);
  EXPECT_EQ(result.wrong_names, 0U);
  EXPECT_EQ(result.false_robots, 0U);
  EXPECT_DOUBLE_EQ((result.errors.at({"blue", 1}).front().pose.x()), 0.04);
  EXPECT_DOUBLE_EQ((result.errors.at({"blue", 2}).front().pose.y()), 0.01);
}

TEST(Evaluation, TellsWrongNamesFromFalseAndMissedRobots) {
  const Evaluation result = evaluate(
      {frame(0,
             {robot(1, "blue", 0.0, 0.0), robot(2, "blue", 1.0, 0.0), robot(3, "blue", 2.0, 0.0)})},
      {frame(0, {robot(1, "blue", 0.0, 0.0), robot(7, "blue", 1.0, 0.0), robot(3, "blue", 2.5, 0.0),
                 robot(1, "blue", 0.01, 0.0)})});
  EXPECT_EQ(result.true_robots, 3U);
  EXPECT_EQ(result.found, 1U);
  EXPECT_EQ(result.wrong_names, 1U);   // 7 stands where 2 is
  EXPECT_EQ(result.false_robots, 2U);  // 3 is half a metre away; 1 is there twice
}

TEST(Evaluation, TeamBelongsToTheName) {
  const Evaluation result = evaluate({frame(0, {robot(1, "blue", 0.0, 0.0)})},
                                     {frame(0, {robot(1, "yellow", 0.0, 0.0)})});
  EXPECT_EQ(result.found, 0U);
  EXPECT_EQ(result.wrong_names, 1U);
}

TEST(Evaluation, FramesThatWereNotReportedCountAsMissed) {
  const Evaluation result =
      evaluate({frame(0, {robot(1, "blue", 0.0, 0.0)}), frame(1, {robot(1, "blue", 0.0, 0.0)})},
               {frame(1, {robot(1, "blue", 0.0, 0.0)}), frame(9, {})});
  EXPECT_EQ(result.frames, 2U);
  EXPECT_EQ(result.true_robots, 2U);
  EXPECT_EQ(result.found, 1U);
  EXPECT_EQ(result.frames_without_truth, 1U);
}

TEST(Evaluation, AnonymousRobotsArePairedByPlaceAndMayNotChangeTheirTrackNumber) {
  EvaluationOptions options;
  options.anonymous = true;
  const std::vector<LoggedFrame> truth = {frame(0, {robot(4, "blue", 0.0, 0.0)}),
                                          frame(1, {robot(4, "blue", 0.1, 0.0)}),
                                          frame(2, {robot(4, "blue", 0.2, 0.0)})};
  const Evaluation result =
      evaluate(truth,
               {frame(0, {robot(0, "blue", 0.0, 0.0)}), frame(1, {robot(5, "blue", 0.1, 0.0)}),
                frame(2, {robot(5, "blue", 0.2, 0.0)})},
               options);
  EXPECT_EQ(result.found, 2U);
  EXPECT_EQ(result.wrong_names, 1U);
  EXPECT_EQ(result.false_robots, 0U);
}

TEST(Evaluation, HeadingErrorsGoTheShortWayRound) {
  const Evaluation result = evaluate({frame(0, {robot(1, "blue", 0.0, 0.0, 3.1)})},
                                     {frame(0, {robot(1, "blue", 0.0, 0.0, -3.1)})});
  EXPECT_NEAR((result.errors.at({"blue", 1}).front().pose.z()), 2.0 * M_PI - 6.2, 1e-12);
}

TEST(Reception, CountsWhatWasLostAndTakesTimesFromPublishToReceive) {
  const std::vector<LoggedFrame> poses = {frame(0, {robot(1, "blue", 0, 0)}),
                                          frame(1, {robot(1, "blue", 0, 0)}),
                                          frame(2, {robot(1, "blue", 0, 0)})};
  const Reception reception = judge_reception(
      poses, {{0, 1, "blue", 0, 100'000}, {2, 1, "blue", 500'000'000, 500'300'000}});
  EXPECT_EQ(reception.logged, 3U);
  EXPECT_EQ(reception.received, 2U);
  EXPECT_EQ(reception.lost, 1U);
  EXPECT_DOUBLE_EQ(reception.latency_p50_us, 100.0);
  EXPECT_DOUBLE_EQ(reception.latency_p99_us, 300.0);
  EXPECT_NEAR(reception.frame_rate_hz, 1.0 / 0.5002, 1e-9);
}

TEST(ErrorStatistics, KnowsRmsBiasAndPercentileOfKnownErrors) {
  PoseError right;
  right.pose = {0.003, 0.004, 0.1};
  right.covariance = fusion::PoseCovariance::Identity();
  PoseError left = right;
  left.pose = {-0.001, 0.0, -0.1};
  const ErrorStatistics result = summarise({right, left});
  EXPECT_DOUBLE_EQ(result.rms.x(), std::sqrt((9e-6 + 1e-6) / 2.0));
  EXPECT_DOUBLE_EQ(result.bias.x(), 0.001);
  EXPECT_DOUBLE_EQ(result.rms_position_m, std::sqrt((25e-6 + 1e-6) / 2.0));
  EXPECT_DOUBLE_EQ(result.p95_position_m, 0.005);
  EXPECT_DOUBLE_EQ(result.rms.z(), 0.1);
  EXPECT_DOUBLE_EQ(result.bias.z(), 0.0);
}

TEST(ErrorStatistics, NeesOfDrawnErrorsLiesInItsBandAndLeavesItWithAWrongCovariance) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d root;  // Cholesky factor of the covariance, with cross terms
  root << 2e-3, 0, 0, 1e-3, 1e-3, 0, 5e-3, -4e-3, 2e-2;
  std::vector<PoseError> errors(2000);
  for (PoseError& error : errors) {
    error.pose = root * Eigen::Vector3d(normal(random), normal(random), normal(random));
    error.covariance = root * root.transpose();
  }
  const Band band = nees_band95(errors.size());
  const ErrorStatistics honest = summarise(errors);
  EXPECT_GT(honest.mean_nees, band.low);
  EXPECT_LT(honest.mean_nees, band.high);
  EXPECT_NEAR(honest.coverage95, 0.95, 0.02);  // four standard deviations of the share

  for (PoseError& error : errors) error.covariance /= 2.0;
  const ErrorStatistics boastful = summarise(errors);
  EXPECT_NEAR(boastful.mean_nees, 2.0 * honest.mean_nees, 1e-9);
  EXPECT_GT(boastful.mean_nees, band.high);
}

TEST(ErrorStatistics, LeavesSingularCovariancesOutAndCountsThem) {
  PoseError error;
  error.pose = {1e-3, 0.0, 0.0};
  const ErrorStatistics result = summarise({error});
  EXPECT_EQ(result.singular, 1U);
  EXPECT_EQ(result.mean_nees, 0.0);
}

// Quantiles from tables of chi-square: 30 degrees of freedom, 16.791 and 46.979.
TEST(ErrorStatistics, NeesBandAgreesWithTabulatedQuantiles) {
  const Band band = nees_band95(10);
  EXPECT_NEAR(band.low, 1.6791, 0.01);
  EXPECT_NEAR(band.high, 4.6979, 0.01);
}

}  // namespace
}  // namespace nadir::tracker
