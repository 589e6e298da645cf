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

TEST(RoverRun, LookingBeforeDrivingIsWorthHalfTheError) {
  EXPECT_LT(runs_of("eso10_tight", 5).position_rms_m, 0.6 * runs_of("eso10", 5).position_rms_m);
}

TEST(NeesBand, IsThatOfTheTables) {
  EXPECT_NEAR(nees_band(40).first, 2.289, 0.005);
  EXPECT_NEAR(nees_band(40).second, 3.805, 0.005);
  EXPECT_NEAR(nees_band(200).first, 2.670, 0.005);
  EXPECT_NEAR(nees_band(200).second, 3.349, 0.005);
}

}  // namespace
}  // namespace nadir::control_client
