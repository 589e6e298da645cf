// nadir-fuse as a user starts it: what it writes where, and what it says of wrong input.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"
#include "vision/input/csv_table.h"

namespace nadir::fusion {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::filesystem::path kDemo = std::filesystem::path(NADIR_DATA_DIR) / "fusion/demo";

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

Outcome run(const std::vector<std::string>& arguments) {
  test::ChildProcess child(NADIR_FUSE, arguments);
  const auto code = child.wait(std::chrono::seconds(60));
  return {code.value_or(-1), child.out(), child.err()};
}

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Exit code 2, nothing on stdout, one line on stderr that holds `words`.
void expect_refusal(const Outcome& outcome, const std::string& words) {
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("nadir-fuse: "));
  EXPECT_THAT(outcome.err, HasSubstr(words));
}

class FuseCommand : public testing::Test {
 protected:
  Outcome fuse(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--odometry", odometry_, "--poses", poses_,
                                          "--filter",   filter_,   "-o",      estimates_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// The demo's vision log with its first `count` rows only, and these rows after them.
  std::string vision_log(int count, const std::string& rows) const {
    std::istringstream lines(read_text(kDemo / "vision.csv"));
    std::string text;
    std::string line;
    for (int i = 0; i < count + 2 && std::getline(lines, line); ++i) text += line + "\n";
    return scratch_.write("vision.csv", text + rows);
  }

  vision::ScratchFolder scratch_;
  std::string odometry_ = kDemo / "odometry.csv";
  std::string poses_ = kDemo / "vision.csv";
  std::string filter_ = "ekf";
  std::string estimates_ = scratch_.path() / "est.csv";
};

TEST_F(FuseCommand, WritesARowAnOdometryRowWithTheColumnsOfTheContract) {
  const Outcome outcome = fuse();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const std::string text = read_text(estimates_);
  EXPECT_THAT(text, StartsWith("t_s,x_m,y_m,heading_rad,cov_xx,cov_xy,cov_xh,cov_yy,cov_yh,cov_hh\n"
                               "0,nan,nan,"));
  const auto odometry = vision::CsvTable::load(odometry_, {"t_s"});
  const auto estimates = vision::CsvTable::load(estimates_, {"t_s"});
  ASSERT_EQ(estimates.rows(), odometry.rows());
  for (std::size_t i = 0; i < odometry.rows(); ++i) {
    EXPECT_EQ(estimates.number(i, 0), odometry.number(i, 0));
  }
}

TEST_F(FuseCommand, SummaryHoldsTheFieldsOfTheContractForBothFilters) {
  for (const char* filter : {"nominal", "ekf"}) {
    filter_ = filter;
    const std::string file = scratch_.path() / "summary.json";
    const Outcome outcome = fuse({"--truth", kDemo / "truth.csv", "--json", file});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(read_text(file));
    EXPECT_LT(json.at("position_rms_m"), 0.004);
    EXPECT_LT(json.at("heading_rms_rad"), 0.025);
    EXPECT_GT(json.at("nees"), 1.5);
    EXPECT_LT(json.at("nees"), 4.5);
    EXPECT_NEAR(json.at("nis"), 2.9, 0.4);
    EXPECT_GT(json.at("accepted"), 400);
    EXPECT_GT(json.at("rejected"), 10);  // one in twenty is a lie
    EXPECT_EQ(json.at("recovered"), 0);
    EXPECT_EQ(json.at("accepted").get<int>() + json.at("rejected").get<int>() +
                  json.at("not_arrived").get<int>(),
              426);
  }
}

TEST_F(FuseCommand, ErrorsAreNullWithoutTruth) {
  const std::string file = scratch_.path() / "summary.json";
  ASSERT_EQ(fuse({"--json", file}).code, 0);
  const auto json = nlohmann::json::parse(read_text(file));
  EXPECT_TRUE(json.at("position_rms_m").is_null());
  EXPECT_TRUE(json.at("heading_rms_rad").is_null());
  EXPECT_TRUE(json.at("nees").is_null());
  EXPECT_FALSE(json.at("nis").is_null());
}

TEST_F(FuseCommand, IsCausal) {
  ASSERT_EQ(fuse().code, 0);
  const std::string all = read_text(estimates_);
  // What arrives after the 300th row of the odometry changes no row before.
  const auto odometry = vision::CsvTable::load(odometry_, {"t_s"});
  const double cut_s = odometry.number(300, 0);
  const auto vision = vision::CsvTable::load(poses_, {"t_arrival_s"});
  int heard = 0;
  while (vision.number(static_cast<std::size_t>(heard), 0) <= cut_s) ++heard;
  poses_ = vision_log(heard, "");
  ASSERT_EQ(fuse().code, 0);
  const std::string early = read_text(estimates_);
  const auto nth_line = [](const std::string& text, int n) {
    std::size_t place = 0;
    for (int i = 0; i < n; ++i) place = text.find('\n', place) + 1;
    return text.substr(0, place);
  };
  EXPECT_EQ(nth_line(all, 302), nth_line(early, 302));
  EXPECT_NE(all, early);
}

/// Of the estimates against the demo's truth, from the second second on.
double position_rms_m(const std::filesystem::path& file) {
  const auto estimates = vision::CsvTable::load(file, {"t_s", "x_m", "y_m"});
  const auto truth = vision::CsvTable::load(kDemo / "truth.csv", {"t_s", "x_m", "y_m"});
  double squares = 0.0;
  int count = 0;
  // The truth's rows are those of the odometry from the second on.
  for (std::size_t i = 50; i < truth.rows() && i + 1 < estimates.rows(); ++i) {
    EXPECT_NEAR(estimates.number(i + 1, 0), truth.number(i, 0), 1e-9);
    squares += std::pow(estimates.number(i + 1, 1) - truth.number(i, 1), 2) +
               std::pow(estimates.number(i + 1, 2) - truth.number(i, 2), 2);
    ++count;
  }
  return std::sqrt(squares / count);
}

TEST_F(FuseCommand, SmoothedPosesAreFarBetterThanTheFilters) {
  const std::string smoothed = scratch_.path() / "smoothed.csv";
  ASSERT_EQ(fuse({"--smooth", smoothed}).code, 0);
  EXPECT_LT(position_rms_m(estimates_), 0.004);
  EXPECT_LT(position_rms_m(smoothed), 0.7 * position_rms_m(estimates_));
}

TEST_F(FuseCommand, StdoutIsForOneOfTheTwo) {
  estimates_ = "-";
  const Outcome outcome = fuse();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, StartsWith("t_s,x_m,"));
  expect_refusal(fuse({"--json", "-"}), "both want stdout");
}

TEST_F(FuseCommand, EffectiveSettingsCanBePrintedAndReadBack) {
  const Outcome printed = run({"--print-config"});
  EXPECT_EQ(printed.code, 0) << printed.err;
  const std::string file = scratch_.write("printed.yaml", printed.out);
  EXPECT_EQ(run({"--print-config", "--config", file}).out, printed.out);
  const std::string changed =
      scratch_.write("changed.yaml", "gate: {kind: rectangular}\nodometry: {lead_s: 0.2}\n");
  const std::string out = run({"--print-config", "--config", changed}).out;
  EXPECT_THAT(out, HasSubstr("kind: rectangular\n  threshold: 3\n"));
  EXPECT_THAT(out, HasSubstr("lead_s: 0.2\n"));
}

TEST_F(FuseCommand, KnownStartGivesEstimatesFromTheFirstRow) {
  const std::string config = scratch_.write(
      "start.yaml", "start: {x_m: -0.346, y_m: 0.043, heading_rad: 0.58, sigma_m: 0.01}\n");
  ASSERT_EQ(fuse({"--config", config}).code, 0);
  const auto estimates = vision::CsvTable::load(estimates_, {"x_m", "cov_xx"});
  EXPECT_NEAR(estimates.number(0, 0), -0.346, 1e-3);
  EXPECT_NEAR(estimates.number(0, 1), 1e-4, 2e-6);
}

TEST_F(FuseCommand, RowsThatMakeNoSenseAreCountedAndNamed) {
  poses_ = vision_log(10,
                      "0.60,0.70,nan,0,0,9e-06,9e-06,0.0004\n"
                      "0.62,0.70,0,0,0,-9e-06,9e-06,0.0004\n"
                      "0.62,0.70,0,0,0,9e-06,inf,0.0004\n"
                      "5.00,0.71,0,0,0,9e-06,9e-06,0.0004\n");
  const std::string file = scratch_.path() / "summary.json";
  const Outcome outcome = fuse({"--json", file});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr(poses_ + ":13: not finite (2 such rows)"));
  EXPECT_THAT(outcome.err,
              HasSubstr(poses_ + ":14: covariance not positive definite (1 such row)"));
  EXPECT_THAT(outcome.err, HasSubstr(poses_ + ":16: from the future (1 such row)"));
  const auto poses = nlohmann::json::parse(read_text(file)).at("poses");
  EXPECT_EQ(poses.at("not_finite"), 2);
  EXPECT_EQ(poses.at("covariance_not_positive"), 1);
  EXPECT_EQ(poses.at("from_the_future"), 1);
}

TEST_F(FuseCommand, RefusesWrongUsageWithOneLine) {
  expect_refusal(run({}), "--odometry is required");
  expect_refusal(run({"--odometry", odometry_}), "--poses is required");
  filter_ = "kalman";
  expect_refusal(fuse(), "--filter");
  filter_ = "ekf";
  expect_refusal(fuse({"--nominal", kDemo / "odometry.csv"}), "--nominal goes with");
  expect_refusal(fuse({"--smoth", "x.csv"}), "--smoth");
}

TEST_F(FuseCommand, RefusesBadFilesWithOneLineThatNamesThePlace) {
  const std::string good = odometry_;
  odometry_ = scratch_.path() / "none.csv";
  expect_refusal(fuse(), "none.csv");
  odometry_ = scratch_.write("odo.csv", "t_s,u_mps,v_mps\n0,0,0\n");
  expect_refusal(fuse(), "odo.csv:1:1: the header lacks the column 'r_radps'");
  odometry_ = scratch_.write("odo.csv", "t_s,u_mps,v_mps,r_radps\n0,0,0,0\n0.1,fast,0,0\n");
  expect_refusal(fuse(), "odo.csv:3:5: u_mps is 'fast'");
  odometry_ = scratch_.write("odo.csv", "t_s,u_mps,v_mps,r_radps\n1700000000000000000,0,0,0\n");
  expect_refusal(fuse(), "odo.csv:2:1: the time is 1700000000000000000 s; write seconds");
  odometry_ = scratch_.write("odo.csv", "t_s,u_mps,v_mps,r_radps\n");
  expect_refusal(fuse(), "odo.csv: holds no rows");
  odometry_ = good;
  poses_ = vision_log(2, "0.5,0.01,0,0,0,1,1,1\n");
  expect_refusal(fuse(), "vision.csv:5:5: t_arrival_s 0.01 is before that of the row above");
  poses_ = kDemo / "vision.csv";
  const std::string truth = scratch_.write("t.csv", "t_s,x_m,y_m,heading_rad\n2,0,0,0\n1,0,0,0\n");
  expect_refusal(fuse({"--truth", truth}), "t.csv:3:1: t_s 1 is before");
  estimates_ = scratch_.path() / "no/folder/est.csv";
  expect_refusal(fuse(), "cannot be written");
}

TEST_F(FuseCommand, RefusesBadSettingsWithOneLineThatNamesThePlace) {
  const auto config = [&](const std::string& text) {
    return fuse({"--config", scratch_.write("c.yaml", text)});
  };
  expect_refusal(config("gate:\n  kind: round\n"), "c.yaml:2:");
  expect_refusal(config("gates: {kind: none}\n"), "did you mean 'gate'");
  expect_refusal(config("odometry:\n  lead_s: 7\n"), "c.yaml:2:");
  expect_refusal(config("odometry:\n  lead: 0.1\n"), "lead_s");
  expect_refusal(config("start: {x_m: 0}\n"), "y_m");
  EXPECT_FALSE(std::filesystem::exists(estimates_));
}

TEST_F(FuseCommand, ExplainsItself) {
  EXPECT_THAT(run({"--version"}).out, StartsWith("nadir-fuse "));
  EXPECT_THAT(run({"--help"}).out, HasSubstr("Example: nadir-fuse"));
}

}  // namespace
}  // namespace nadir::fusion
