#include "tracker/robot_tracks.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace nadir::tracker {
namespace {

using Verdict = TrackDecision::Verdict;
constexpr double kFrame_s = 1.0 / 30.0;

vision::CaptureTime at(double time_s) {
  return vision::CaptureTime{} + std::chrono::nanoseconds(std::llround(1e9 * (1.7e9 + time_s)));
}

TrackCandidate robot(double x_m, double y_m, int read_id, double confidence = 0.9) {
  TrackCandidate candidate;
  candidate.read_id = read_id;
  candidate.pose_world_robot = {x_m, y_m, 0.0};
  candidate.covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
  candidate.confidence = confidence;
  return candidate;
}

TrackCandidate anonymous(double x_m, double y_m) { return robot(x_m, y_m, -1); }

// Frames of 30 per second, one after the other.
class Story {
 public:
  std::vector<TrackDecision> frame(const std::vector<TrackCandidate>& candidates) {
    const auto decisions = tracks_.update(at(time_s_), candidates);
    time_s_ += kFrame_s;
    return {decisions.begin(), decisions.end()};
  }
  std::vector<int> ids(const std::vector<TrackCandidate>& candidates) {
    std::vector<int> result;
    for (const TrackDecision& decision : frame(candidates)) result.push_back(decision.id);
    return result;
  }
  void wait(double seconds) { time_s_ += seconds; }

 private:
  RobotTracks tracks_;
  double time_s_ = 0.0;
};

TEST(RobotTracks, NumbersAnonymousRobotsFromZero) {
  Story story;
  EXPECT_EQ(story.ids({anonymous(0, 0), anonymous(1, 0), anonymous(2, 0)}), (std::vector{0, 1, 2}));
  // The order of the candidates does not matter.
  EXPECT_EQ(story.ids({anonymous(2, 0), anonymous(0, 0.01), anonymous(1, 0)}),
            (std::vector{2, 0, 1}));
}

TEST(RobotTracks, KeepsNumbersOfCrossingRobots) {
  Story story;
  // Two robots pass each other at 2 m/s each with 0.2 m between their centres; a third stands near.
  for (double x_m = -1.0; x_m < 1.0; x_m += 2.0 * kFrame_s) {
    EXPECT_EQ(story.ids({anonymous(x_m, 0.0), anonymous(-x_m, 0.2), anonymous(0.0, -0.25)}),
              (std::vector{0, 1, 2}))
        << "at x = " << x_m;
  }
}

TEST(RobotTracks, FollowsARobotAtTheSpeedLimitAndNoFaster) {
  Story story;
  EXPECT_EQ(story.ids({anonymous(0, 0)}), std::vector{0});
  EXPECT_EQ(story.ids({anonymous(3.9 * kFrame_s, 0)}), std::vector{0});
  EXPECT_EQ(story.ids({anonymous(3.9 * kFrame_s + 4.3 * kFrame_s, 0)}), std::vector{1});
}

TEST(RobotTracks, FindsALostRobotAgainBeforeItIsForgotten) {
  Story story;
  story.ids({anonymous(0, 0), anonymous(1, 0)});
  story.wait(0.5);
  EXPECT_EQ(story.ids({anonymous(0.1, 0), anonymous(1, 0)}), (std::vector{0, 1}));
  story.ids({anonymous(1, 0)});
  story.wait(0.6);
  story.ids({anonymous(1, 0)});
  story.wait(0.2);
  EXPECT_EQ(story.ids({anonymous(0.1, 0), anonymous(1, 0)}), (std::vector{2, 1}));
}

TEST(RobotTracks, UsesANumberAgainAfterItsRest) {
  Story story;
  story.ids({anonymous(0, 0)});
  story.wait(1.0);
  EXPECT_EQ(story.ids({anonymous(0, 0)}), std::vector{1});
  for (int k = 0; k < 22; ++k) {
    story.wait(0.5);
    EXPECT_EQ(story.ids({anonymous(0, 0)}), std::vector{1});
  }
  EXPECT_EQ(story.ids({anonymous(0, 0), anonymous(3, 0)}), (std::vector{1, 0}));
}

TEST(RobotTracks, StartsAfreshWhenTimeRunsBackwards) {
  RobotTracks tracks;
  tracks.update(at(10.0), std::vector{anonymous(0, 0), anonymous(1, 0)});
  EXPECT_EQ(tracks.update(at(2.0), std::vector{anonymous(1, 0)})[0].id, 0);
}

TEST(RobotTracks, ReportsAConfidentReadingAtOnce) {
  Story story;
  const auto decisions = story.frame({robot(0, 0, 5), robot(1, 0, 11)});
  EXPECT_EQ(decisions[0].id, 5);
  EXPECT_EQ(decisions[1].id, 11);
  EXPECT_EQ(decisions[0].verdict, Verdict::kReport);
}

TEST(RobotTracks, WaitsForASecondLookAtADoubtfulReading) {
  Story story;
  EXPECT_EQ(story.frame({robot(0, 0, 5, 0.1)})[0].verdict, Verdict::kUncertain);
  EXPECT_EQ(story.frame({robot(0, 0, 6, 0.1)})[0].verdict, Verdict::kUncertain);
  EXPECT_EQ(story.frame({robot(0, 0, 6, 0.1)})[0].verdict, Verdict::kReport);
}

TEST(RobotTracks, KeepsTheVotedNumberWhenSingleFramesFlicker) {
  Story story;
  for (int k = 0; k < 60; ++k) {
    // One robot stands, one drives at 1.5 m/s; from the fourth frame on each is misread now and
    // then.
    const int stands = k > 3 && k % 5 == 0 ? 9 : 3;
    const int drives = k > 3 && k % 7 == 0 ? 3 : 8;
    EXPECT_EQ(story.ids({robot(0, 0, stands), robot(1.0 + 1.5 * kFrame_s * k, 1, drives)}),
              (std::vector{3, 8}))
        << "frame " << k;
  }
}

TEST(RobotTracks, BelievesANewNumberAfterFourEqualFrames) {
  Story story;
  for (int k = 0; k < 30; ++k) story.frame({robot(0, 0, 3)});
  std::vector<int> ids;
  for (int k = 0; k < 5; ++k) ids.push_back(story.ids({robot(0, 0, 4)})[0]);
  EXPECT_EQ(ids, (std::vector{3, 3, 3, 4, 4}));
}

TEST(RobotTracks, OfTwoEqualNumbersKeepsTheOneThatWasThere) {
  Story story;
  for (int k = 0; k < 5; ++k) story.frame({robot(0, 0, 3, 0.7)});
  for (int k = 0; k < 5; ++k) {
    const auto decisions = story.frame({robot(2, 0, 3, 0.95), robot(0, 0, 3, 0.7)});
    EXPECT_EQ(decisions[0].verdict, Verdict::kDuplicate);
    EXPECT_EQ(decisions[1].verdict, Verdict::kReport);
  }
}

TEST(RobotTracks, OfTwoEqualNumbersAtFirstSightTakesTheMoreConfident) {
  Story story;
  const auto decisions =
      story.frame({robot(0, 0, 3, 0.7), robot(2, 0, 3, 0.9), robot(4, 0, 3, 0.8)});
  EXPECT_EQ(decisions[0].verdict, Verdict::kDuplicate);
  EXPECT_EQ(decisions[1].verdict, Verdict::kReport);
  EXPECT_EQ(decisions[2].verdict, Verdict::kDuplicate);
}

TEST(RobotTracks, KindsDoNotShareNumbers) {
  Story story;
  TrackCandidate yellow = robot(1, 0, 3);
  yellow.kind = 1;
  for (int k = 0; k < 5; ++k) {
    const auto decisions = story.frame({robot(0, 0, 3), yellow});
    EXPECT_EQ(decisions[0].verdict, Verdict::kReport);
    EXPECT_EQ(decisions[1].verdict, Verdict::kReport);
  }
}

TEST(RobotTracks, BelievesReadingsWhenRobotsAreMovedByHand) {
  Story story;
  for (int k = 0; k < 20; ++k) story.frame({robot(0, 0, 3), robot(1, 0, 7)});
  // Swapped between two frames: continuity must not say otherwise.
  EXPECT_EQ(story.ids({robot(0, 0, 7), robot(1, 0, 3)}), (std::vector{7, 3}));
  // Gone to far places, one to the place of another.
  EXPECT_EQ(story.ids({robot(3, 2, 7), robot(0, 0, 5), robot(-2, 1, 3)}), (std::vector{7, 5, 3}));
}

// Frames that have nothing to do with each other, as in a test of a detector: every reading counts.
TEST(RobotTracks, DoesNotVetoReadingsOfTeleportingRobots) {
  Story story;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x_m(-2.0, 2.0);
  std::uniform_real_distribution<double> y_m(-1.5, 1.5);
  for (int k = 0; k < 2000; ++k) {
    std::vector<TrackCandidate> robots;
    for (int id = 0; id < 12; ++id) robots.push_back(robot(x_m(random), y_m(random), id));
    std::ranges::shuffle(robots, random);
    const auto decisions = story.frame(robots);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      ASSERT_EQ(decisions[i].id, robots[i].read_id) << "frame " << k;
      ASSERT_EQ(decisions[i].verdict, Verdict::kReport) << "frame " << k;
    }
  }
}

TEST(RobotTracks, KeepsNamedNumbersWhileRobotsCross) {
  Story story;
  for (int k = 0; k < 60; ++k) {
    const double x_m = -1.0 + 1.0 * kFrame_s * k;
    // They meet at x = 0 (frame 30), 0.18 m apart; there both are misread.
    const bool blurred = k >= 29 && k <= 31;
    EXPECT_EQ(story.ids({robot(x_m, 0.0, blurred ? 1 : 0), robot(-x_m, 0.18, blurred ? 2 : 12)}),
              (std::vector{0, 12}))
        << "frame " << k;
  }
}

TEST(RobotTracks, IsDeterministic) {
  const auto run = [] {
    Story story;
    std::mt19937 random(3);
    std::normal_distribution<double> step_m(0.0, 0.05);
    std::vector<TrackCandidate> robots;
    for (int i = 0; i < 10; ++i) robots.push_back(anonymous(0.1 * i, 0.0));
    std::vector<int> ids;
    for (int k = 0; k < 100; ++k) {
      for (TrackCandidate& one : robots) one.pose_world_robot.x_m += step_m(random);
      for (const int id : story.ids(robots)) ids.push_back(id);
    }
    return ids;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace nadir::tracker
