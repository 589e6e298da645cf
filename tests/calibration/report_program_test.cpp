// The report and the comparison, with the program as a user starts it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "calibration/report/report_svg.h"
#include "tests/calibration/synthetic_points.h"
#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

Outcome run(const Words& arguments) {
  test::ChildProcess child(NADIR_CALIBRATE, arguments);
  const auto code = child.wait(std::chrono::seconds(100));
  return {code.value_or(-1), child.out(), child.err()};
}

std::string csv(const FieldPoints& points) {
  std::ostringstream text;
  text.precision(12);
  text << "u_px,v_px,x_m,y_m\n";
  for (const FieldPoint& point : points.points) {
    text << point.pixel.x() << "," << point.pixel.y() << "," << point.position_m.x() << ","
         << point.position_m.y() << "\n";
  }
  return text.str();
}

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

class Report : public testing::Test {
 protected:
  /// Fits, with a report and JSON. Returns the JSON; the page is in html_.
  nlohmann::json report(const FieldPoints& points, const Words& more) {
    const std::string page = folder_.path() / "report.html";
    const std::string json = folder_.path() / "report.json";
    Words arguments = {"field",    folder_.write("points.csv", csv(points)),
                       "--height", "0.1",
                       "-o",       folder_.path() / "cal.yaml",
                       "--report", page,
                       "--json",   json};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    html_ = text_of(page);
    return nlohmann::json::parse(text_of(json));
  }

  vision::ScratchFolder folder_;
  std::string html_;
};

TEST_F(Report, IsOnePageThatNeedsNothingElse) {
  std::mt19937_64 random(3);
  auto points = with_noise(grid_points(10, 8, quadratic_truth), 0.3, 0.0, random);
  for (FieldPoint& point : points.points) point.pixel += Eigen::Vector2d(5.0, 5.0);
  const auto json = report(points, {"--pixel-noise", "0.3", "--image-size", "1290x970"});
  EXPECT_THAT(html_, testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(html_, testing::EndsWith("</html>\n"));
  for (const char* foreign : {"http://", "https://", "<script", "<link", "src=", "@import"}) {
    EXPECT_THAT(html_, Not(HasSubstr(foreign)));
  }
  EXPECT_EQ(count(html_, "<figure>"), 6U);
  EXPECT_EQ(count(html_, "<svg"), count(html_, "</svg>"));
  for (const char* no_number : {">nan", ">inf", "\"nan", "\"inf", "-nan"}) {
    EXPECT_THAT(html_, Not(HasSubstr(no_number)));
  }
  for (const char* part :
       {"x on the field, m", "u in the image, px", "residual per axis / stated sigma",
        "cross-validated, mm", "Worst points", "radial2"}) {
    EXPECT_THAT(html_, HasSubstr(part));
  }
  // The page says what the JSON says.
  EXPECT_NEAR(json.at("histogram").at("beyond_two_sigma").get<double>(), 0.0455, 0.04);
  EXPECT_EQ(json.at("histogram").at("normalised_residuals").size(), 160U);
  EXPECT_GT(json.at("coverage").at("hull_share").get<double>(), 0.95);
  EXPECT_EQ(json.at("coverage").at("points_per_cell").size(), 48U);
}

TEST_F(Report, HalvesAgreeWhereNoiseIsAllThereIs) {
  // Over several sets: the half-data difference is what the sampling error predicts.
  double ratio = 0.0;
  constexpr int kSets = 5;
  for (std::uint64_t seed = 0; seed < kSets; ++seed) {
    std::mt19937_64 random(seed);
    const auto points = with_noise(grid_points(12, 10, quadratic_truth), 0.3, 0.0, random);
    const auto halves = report(points, {"--pixel-noise", "0.3"}).at("half_data");
    ratio += halves.at("rms_m").get<double>() / halves.at("expected_rms_m").get<double>() / kSets;
  }
  EXPECT_GT(ratio, 0.6);
  EXPECT_LT(ratio, 1.5);
}

TEST_F(Report, ShowsALensThatDoesNotFit) {
  std::mt19937_64 random(4);
  const auto points = with_noise(grid_points(12, 9, barrel_truth), 0.05, 0.0, random);
  const auto json = report(points, {"--pixel-noise", "0.05", "--force"});
  EXPECT_GT(json.at("histogram").at("beyond_two_sigma").get<double>(), 0.4);
  EXPECT_THAT(html_, Not(HasSubstr("class=\"grade pass\"")));
}

TEST_F(Report, EscapesWhatTheFileIsCalled) {
  EXPECT_EQ(html_escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
}

TEST(RoundTicks, AreRoundAndInside) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {0.0, 1.0}, {-2.3, 4.1}, {960.0, 0.0}, {0.0, 3e-4}, {1e3, 1.01e3}}) {
    const auto ticks = round_ticks(low, high, 6);
    ASSERT_GE(ticks.size(), 2U);
    EXPECT_LE(ticks.size(), 12U);
    const double step = ticks[1] - ticks[0];
    const double digits = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(digits - 1) < 1e-6 || std::abs(digits - 2) < 1e-6 ||
                std::abs(digits - 5) < 1e-6)
        << step;
    for (const double tick : ticks) {
      EXPECT_GE(tick, std::min(low, high) - 1e-9);
      EXPECT_LE(tick, std::max(low, high) + 1e-9);
    }
  }
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-1e-17, 0.5), "0.0");
  EXPECT_EQ(tick_text(-20, 10), "\u221220");
  EXPECT_EQ(heat_colour(0.0), "#30195f");
  EXPECT_EQ(heat_colour(7.0), heat_colour(1.0));
}

class Compare : public Report {};

TEST_F(Compare, SaysWhereAndHowMuchTwoCalibrationsDiffer) {
  const auto points = grid_points(9, 8, quadratic_truth);
  FieldPoints knocked = points;
  for (FieldPoint& point : knocked.points) point.pixel += Eigen::Vector2d(2.0, -1.0);
  const auto fitted = [&](const char* name, const FieldPoints& from) {
    const std::string file = folder_.path() / name;
    const Outcome outcome = run({"field", folder_.write("points.csv", csv(from)), "--height", "0.1",
                                 "--pixel-noise", "0.2", "--force", "-o", file});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return file;
  };
  const std::string before = fitted("before.yaml", points);
  const std::string after = fitted("after.yaml", knocked);
  const std::string json_file = folder_.path() / "difference.json";
  const Outcome outcome = run({"compare", before, after, "--json", json_file});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Was the camera knocked"));
  const auto json = nlohmann::json::parse(text_of(json_file));
  EXPECT_TRUE(json.at("significant").get<bool>());
  EXPECT_NEAR(json.at("rms_px").get<double>(), std::sqrt(5.0), 0.05);
  EXPECT_NEAR(json.at("motion").at("shift_x_m").get<double>(), -2.0 * 3.0e-3, 5e-4);
  EXPECT_EQ(json.at("map").size(), json.at("points").get<std::size_t>());

  const Outcome same = run({"compare", before, before, "--json", "-"});
  EXPECT_EQ(same.code, 0);
  EXPECT_FALSE(nlohmann::json::parse(same.out).at("significant").get<bool>());
  EXPECT_THAT(same.err, HasSubstr("They agree"));
  const Outcome missing = run({"compare", before, "none.yaml"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.yaml"));
}

}  // namespace
}  // namespace nadir::calibration
