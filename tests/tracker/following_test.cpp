// Robots that are followed by alignment stay who they are: touching, crossing, covered, carried
// away.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "tests/support/following_study.h"

namespace nadir::tracker {
namespace {

using support::FollowingStory;
using support::FollowingStudy;

FollowingStudy study(const FollowingStory& story) {
  const FollowingStudy result = support::study_following(
      vision::load_scene(std::filesystem::path(NADIR_DATA_DIR) / "scenes" / "league_even.yaml"),
      story, 5);
  std::printf(
      "%llu robots in frames, %llu uncovered, %llu of those missed, %llu wrong names, %llu "
      "phantoms, %llu covered but found; RMS %.4f px, worst %.3f px, median frame %.0f us\n",
      static_cast<unsigned long long>(result.robot_frames),
      static_cast<unsigned long long>(result.uncovered),
      static_cast<unsigned long long>(result.missed),
      static_cast<unsigned long long>(result.wrong_ids),
      static_cast<unsigned long long>(result.phantoms),
      static_cast<unsigned long long>(result.covered_found), result.rms_px, result.worst_error_px,
      result.frame_us);
  return result;
}

TEST(Following, TouchingRobotsThatTurnAboutEachOtherStayThemselves) {
  const FollowingStudy result = study({.frames = 60});
  EXPECT_EQ(result.wrong_ids, 0U);
  EXPECT_EQ(result.phantoms, 0U);
  EXPECT_EQ(result.missed, 0U);
  EXPECT_LT(result.rms_px, 0.01);
}

TEST(Following, OneCoveredDiscDoesNotLoseARobotTwoDo) {
  const FollowingStudy one = study({.frames = 60, .covers_one_disc = true});
  EXPECT_EQ(one.wrong_ids, 0U);
  EXPECT_EQ(one.phantoms, 0U);
  EXPECT_LE(static_cast<double>(one.missed), 0.005 * static_cast<double>(one.uncovered));
  EXPECT_GT(one.covered_found, 0U);
  const FollowingStudy two = study({.frames = 60, .covers_two_discs = true});
  EXPECT_EQ(two.wrong_ids, 0U);
  EXPECT_EQ(two.phantoms, 0U);
}

TEST(Following, ClutterAndRobotsCarriedAwayGiveNobodyAWrongName) {
  const FollowingStudy result = study({.frames = 90, .balls = true, .swaps = true});
  EXPECT_EQ(result.wrong_ids, 0U);
  EXPECT_EQ(result.phantoms, 0U);
  EXPECT_LE(static_cast<double>(result.missed), 0.005 * static_cast<double>(result.uncovered));
}

TEST(Following, NewcomersAreReportedWithinFiveFramesAndLostRobotsWithinTwo) {
  const FollowingStudy put_down = study({.frames = 130, .lifts = true});
  EXPECT_EQ(put_down.wrong_ids, 0U);
  EXPECT_EQ(put_down.phantoms, 0U);
  EXPECT_GT(put_down.slowest_newcomer, 1);  // they are searched for in slices
  EXPECT_LE(put_down.slowest_newcomer, 5);
  EXPECT_EQ(put_down.longest_loss, 0);
  // Two covered discs lose a robot; once they can be seen it is found where it was.
  const FollowingStudy lost = study({.frames = 130, .covers_two_discs = true, .swaps = true});
  EXPECT_LE(lost.longest_loss, 2);
  EXPECT_EQ(lost.wrong_ids, 0U);
}

TEST(Following, RobotsThatCrossCloselyStayThemselves) {
  const FollowingStudy result =
      study({.frames = 90, .speed_mps = 3.0, .balls = true, .crossing = true});
  EXPECT_EQ(result.wrong_ids, 0U);
  EXPECT_EQ(result.phantoms, 0U);
  EXPECT_LE(static_cast<double>(result.missed), 0.005 * static_cast<double>(result.uncovered));
}

}  // namespace
}  // namespace nadir::tracker
