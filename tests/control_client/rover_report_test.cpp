#include "control_client/rover/rover_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace nadir::control_client {
namespace {

/// All variants, one short run each.
std::vector<RoverCase> short_cases(const RoverWorld& world) {
  std::vector<RoverCase> cases;
  for (const RoverVariant& variant : rover_variants()) {
    cases.push_back(run_rover_case(world, variant, 3, 1));
  }
  return cases;
}

RoverWorld short_world() {
  RoverWorld world;
  world.duration_s = 12.0;  // the printed gains diverge within this time
  return world;
}

TEST(RoverReport, TextFlagsThePrintedGainsWithTheirPoles) {
  const std::string text = rover_text(short_cases(short_world()));
  EXPECT_NE(text.find("as printed        diverges 1 of 1"), std::string::npos) << text;
  EXPECT_NE(text.find("unstable: Routh margin -64.7, poles +0.29+2.49j"), std::string::npos)
      << text;
  EXPECT_NE(text.find("poles +5.00+13.23j"), std::string::npos) << text;
  EXPECT_NE(text.find("stable: Routh margin +1e+03, poles -5.00 -5.00 -5.00"), std::string::npos);
}

TEST(RoverReport, JsonHasAllFiguresOfRunsThatEnded) {
  const std::vector<RoverCase> cases = short_cases(short_world());
  const nlohmann::json json = nlohmann::json::parse(rover_json(cases, 3));
  ASSERT_EQ(json.at("cases").size(), cases.size());
  EXPECT_EQ(json.at("first_seed"), 3);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const nlohmann::json& each = json.at("cases")[i];
    EXPECT_EQ(each.at("name"), cases[i].variant.name);
    if (cases[i].summary.diverged > 0) {
      EXPECT_FALSE(each.contains("position_rms_m"));
    } else {
      EXPECT_EQ(each.at("position_rms_m"), cases[i].summary.position_rms_m);
      EXPECT_EQ(each.at("nees"), cases[i].summary.nees);
    }
  }
}

TEST(RoverReport, FigureDrawsFourPathsAmongLandmarksAndWayPoints) {
  const RoverWorld world = short_world();
  const std::string svg = rover_figure(world, short_cases(world));
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (auto at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  EXPECT_EQ(count("class=\"landmark\""), world.landmarks_m.size());
  EXPECT_EQ(count("class=\"way\""), world.way_points_m.size());
  EXPECT_EQ(count("class=\"c3\""), 4u);  // path, error, heading, legend
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace nadir::control_client
