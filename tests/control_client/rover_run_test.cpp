// The tour of experiment e11.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "control_client/rover/rover_metrics.h"
#include "control_client/rover/rover_variant.h"

namespace nadir::control_client {
namespace {

RoverSummary runs_of(const std::string& name, int runs) {
  const std::vector<RoverVariant> variants = rover_variants();
  const auto variant = std::find_if(variants.begin(), variants.end(),
                                    [&](const RoverVariant& v) { return v.name == name; });
  if (variant == variants.end()) throw std::invalid_argument(name);
  RoverWorld world;
  world.looks_first = variant->looks_first;
  std::vector<RoverRecord> records;
  for (int run = 0; run < runs; ++run) {
    records.push_back(run_rover(world, variant->settings, static_cast<std::uint64_t>(run)));
  }
  return summarize(world, records);
}

TEST(RoverRun, ASeedIsARun) {
  const NavigatorSettings settings = rover_variants()[2].settings;
  RoverWorld world;
  world.duration_s = 3.0;
  const RoverRecord a = run_rover(world, settings, 7);
  const RoverRecord b = run_rover(world, settings, 7);
  const RoverRecord other = run_rover(world, settings, 8);
  EXPECT_EQ(a.ticks.back().estimate.x_m, b.ticks.back().estimate.x_m);
  EXPECT_NE(a.ticks.back().estimate.x_m, other.ticks.back().estimate.x_m);
}

TEST(RoverRun, WithObserverIsWithinNineMillimetresAndHonest) {
  for (const char* name : {"eso5_tight", "eso10_tight"}) {
    const RoverSummary summary = runs_of(name, 20);
    EXPECT_EQ(summary.diverged, 0) << name;
    EXPECT_EQ(summary.tours_done, 20) << name;
    EXPECT_LT(summary.position_rms_m, 0.009) << name;
    EXPECT_GT(summary.nees, nees_band(20).first) << name;
    EXPECT_LT(summary.nees, nees_band(20).second) << name;
    EXPECT_GT(summary.nees_in_band, 0.9) << name;
  }
}

TEST(RoverRun, ThePrintedObserverGainsDivergeAlways) {
  const RoverSummary summary = runs_of("eso_printed", 20);
  EXPECT_EQ(summary.diverged, 20);
  EXPECT_LT(summary.diverged_s, 20.0);
}

TEST(RoverRun, TheObserverMoreThanHalvesTheErrorOfPredictingByTheCommand) {
  const RoverSummary command = runs_of("command", 5);
  const RoverSummary observer = runs_of("eso10", 5);
  EXPECT_LT(observer.iae_xy_m, 0.5 * command.iae_xy_m);
  EXPECT_LT(observer.heading_deviation_rad, command.heading_deviation_rad);
}

TEST(RoverRun, TheObserverBeatsSmoothedDifferencesByAFifth) {
  const RoverSummary differences = runs_of("differences", 100);
  for (const char* name : {"eso5", "eso10"}) {
    EXPECT_LT(runs_of(name, 100).iae_xy_m, 0.8 * differences.iae_xy_m) << name;
  }
}

TEST(RoverRun, LookingBeforeDrivingIsWorthHalfTheError) {
  EXPECT_LT(runs_of("eso10_tight", 5).position_rms_m, 0.6 * runs_of("eso10", 5).position_rms_m);
}

TEST(RoverNavigator, CorrectsByOneLandmarkAfterTheOtherAsItsFilterDoes) {
  NavigatorSettings settings;
  settings.velocity.observer = observer_of_bandwidth(5.0, settings.rover);
  settings.corrects_one_by_one = true;
  RoverNavigator navigator(settings, {{3.0, 3.0}});
  fusion::EkfSlam<> expected(settings.slam);
  const fusion::PoseCovariance loose = 1e-2 * fusion::PoseCovariance::Identity();
  navigator.start({1.0, 1.0, 0.0}, loose);
  expected.start({1.0, 1.0, 0.0}, loose);
  fusion::Sighting near{{2.0, 0.1}, fusion::sighting_covariance(0.03, 0.002), 4};
  fusion::Sighting far{{5.0, -0.8}, fusion::sighting_covariance(0.03, 0.002), 7};
  // Twice in a scan: one after the other, the second corrects what the first made.
  fusion::Sighting again = near;
  again.measured = {2.05, 0.103};
  const std::vector<fusion::Sighting> scan{near, far, again};
  navigator.tick(scan);
  for (const fusion::Sighting& each : scan) {
    fusion::SightingReport report;
    expected.observe({&each, 1}, {&report, 1});
  }
  ASSERT_EQ(navigator.reports().size(), 3u);
  EXPECT_EQ(navigator.reports()[0].verdict, fusion::SightingVerdict::kNew);
  EXPECT_EQ(navigator.reports()[1].verdict, fusion::SightingVerdict::kNew);
  EXPECT_EQ(navigator.reports()[2].verdict, fusion::SightingVerdict::kUsed);
  EXPECT_EQ(navigator.slam().pose().x_m, expected.pose().x_m);
  EXPECT_EQ(navigator.slam().pose().heading_rad, expected.pose().heading_rad);
  EXPECT_EQ(navigator.slam().landmark_m(0), expected.landmark_m(0));
}

TEST(NeesBand, IsThatOfTheTables) {
  EXPECT_NEAR(nees_band(40).first, 2.289, 0.005);
  EXPECT_NEAR(nees_band(40).second, 3.805, 0.005);
  EXPECT_NEAR(nees_band(200).first, 2.670, 0.005);
  EXPECT_NEAR(nees_band(200).second, 3.349, 0.005);
}

}  // namespace
}  // namespace nadir::control_client
