// What the detector does not take for a robot, and why it says so.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/vision/detector_test_scenes.h"
#include "tests/vision/input_error_line.h"
#include "vision/disc_pattern_detector.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr double kScale_px_per_m = 250.0;
const cv::Vec3b kPlate{36, 36, 36};
const cv::Vec3b kBlue{230, 140, 30};
const cv::Vec3b kYellow{40, 205, 240};
const cv::Vec3b kPink{160, 60, 240};
const cv::Vec3b kGreen{100, 225, 130};

MarkerLayout bundled_layout(const std::string& name) {
  return load_marker_layout(std::filesystem::path(NADIR_DATA_DIR) / "layouts" / (name + ".yaml"));
}

PixelScaleGrid square_grid(int width_px, int height_px, double scale_px_per_m = kScale_px_per_m) {
  const Eigen::Matrix2d metres_per_pixel =
      Eigen::Vector2d(1.0 / scale_px_per_m, -1.0 / scale_px_per_m).asDiagonal();
  return {width_px, height_px, [=](const PixelPoint&) { return metres_per_pixel; }};
}

DetectionResult detect(const cv::Mat& bgr, const MarkerLayout& layout) {
  DiscPatternDetector detector(layout, square_grid(bgr.cols, bgr.rows));
  DetectionResult result;
  detector.detect(bgr, result);
  return result;
}

testing::AssertionResult is_rejected(const DetectionResult& result, RejectReason reason) {
  for (const RejectedCandidate& candidate : result.rejected) {
    if (candidate.reason == reason) return testing::AssertionSuccess();
  }
  testing::AssertionResult failure = testing::AssertionFailure();
  failure << "only:";
  for (const RejectedCandidate& candidate : result.rejected) {
    failure << " '" << reject_reason_text(candidate.reason) << "'";
  }
  return failure;
}

/// The pair layout's two discs: blue at a place, yellow `ahead_m` to its right.
cv::Mat pair_picture(double ahead_m) {
  cv::Mat bgr = flat_picture(120, 90, kPlate);
  fill_disc(bgr, {50.0, 45.0}, 6.25, kBlue);
  fill_disc(bgr, {50.0 + kScale_px_per_m * ahead_m, 45.0}, 6.25, kYellow);
  return bgr;
}

TEST(DetectorRejections, ThePairItselfIsFound) {
  const DetectionResult result = detect(pair_picture(0.060), bundled_layout("pair"));
  ASSERT_EQ(result.robots.size(), 1U);
  EXPECT_NEAR(result.robots[0].discs[1].centre_px.x(), 65.0, 0.3);
}

TEST(DetectorRejections, ALoneCentreDiscHasNoHeadingMarker) {
  cv::Mat bgr = flat_picture(120, 90, kPlate);
  fill_disc(bgr, {50.0, 45.0}, 6.25, kBlue);
  const DetectionResult result = detect(bgr, bundled_layout("pair"));
  EXPECT_TRUE(result.robots.empty());
  EXPECT_TRUE(is_rejected(result, RejectReason::kNoHeadingMarker));
}

TEST(DetectorRejections, AnOuterDiscInTheWrongPlaceDoesNotFit) {
  const DetectionResult result = detect(pair_picture(0.080), bundled_layout("pair"));
  EXPECT_TRUE(result.robots.empty());
  EXPECT_TRUE(is_rejected(result, RejectReason::kPatternDoesNotFit));
}

TEST(DetectorRejections, ASmallDiscHasTheWrongSize) {
  cv::Mat bgr = flat_picture(120, 90, kPlate);
  fill_disc(bgr, {50.0, 45.0}, 3.4, kBlue);
  const DetectionResult result = detect(bgr, bundled_layout("pair"));
  EXPECT_TRUE(result.robots.empty());
  EXPECT_TRUE(is_rejected(result, RejectReason::kWrongSize));
}

TEST(DetectorRejections, AWedgeIsNotRound) {
  cv::Mat bgr = flat_picture(120, 90, kPlate);
  for (int u = 40; u < 80; ++u) {
    const int half = (u - 40) / 3;
    bgr(cv::Rect(u, 45 - half, 1, 2 * half + 1)).setTo(kBlue);
  }
  EXPECT_TRUE(is_rejected(detect(bgr, bundled_layout("pair")), RejectReason::kNotRound));
}

TEST(DetectorRejections, APaleDiscHasTooLittleContrastInItsHue) {
  cv::Mat bgr = flat_picture(120, 90, {25, 12, 2});
  fill_disc(bgr, {50.0, 45.0}, 6.25, {250, 200, 150});
  EXPECT_TRUE(is_rejected(detect(bgr, bundled_layout("pair")), RejectReason::kWeakContrast));
}

TEST(DetectorRejections, ADiscBetweenTwoCentresIsSharedByOneRobotOnly) {
  cv::Mat bgr = pair_picture(0.060);
  fill_disc(bgr, {80.0, 45.0}, 6.25, kBlue);
  const DetectionResult result = detect(bgr, bundled_layout("pair"));
  EXPECT_EQ(result.robots.size(), 1U);
  EXPECT_TRUE(is_rejected(result, RejectReason::kSharedDisc));
}

TEST(DetectorRejections, ARobotOfAnotherTeamHasColoursOfNoKnownOne) {
  const MarkerLayout league = bundled_layout("league");
  MarkerLayout ours = league;
  ours.identities.erase(ours.identities.begin() + 8);
  Renderer renderer(straight_scene(league, 120, 120, kScale_px_per_m), 1);
  const RobotPlacement robot = robot_at(renderer.camera(), league, {60.2, 59.7}, 0.4, 1, 8);
  cv::Mat bgr;
  renderer.render_robots(0, {&robot, 1}, bgr);
  const DetectionResult result = detect(bgr, ours);
  EXPECT_TRUE(result.robots.empty());
  EXPECT_TRUE(is_rejected(result, RejectReason::kUnknownIdentity));
}

// A robot driven out over each border: found right, or said to reach over it.
TEST(DetectorRejections, ARobotAtABorderIsFoundRightOrOutsideTheImage) {
  const MarkerLayout layout = bundled_layout("league");
  Renderer renderer(straight_scene(layout, 130, 110, kScale_px_per_m), 1);
  const PixelScaleGrid scale = scale_of(renderer.camera(), layout.height_m);
  DiscPatternDetector detector(layout, scale);
  RandomStream random(2);
  DetectionResult result;
  cv::Mat bgr;
  int found = 0;
  int outside = 0;
  for (int i = 0; i < 400; ++i) {
    const double depth_px = random.uniform(6.5, 30.0);  // of the centre: its own disc is in
    const PixelPoint places[] = {
        {depth_px, 55.0}, {129.0 - depth_px, 55.0}, {65.0, depth_px}, {65.0, 109.0 - depth_px}};
    const int id = static_cast<int>(random.below(16));
    const RobotPlacement robot = robot_at(renderer.camera(), layout, places[i % 4],
                                          random.uniform(0.0, 2.0 * M_PI), random.below(2), id);
    renderer.render_robots(i, {&robot, 1}, bgr);
    detector.detect(bgr, result);
    if (!result.robots.empty()) {
      ++found;
      EXPECT_EQ(layout.identities[result.robots[0].identity].id, id);
      EXPECT_LT((result.robots[0].discs[0].centre_px - places[i % 4]).norm(), 0.2);
    } else {
      ++outside;
      EXPECT_TRUE(is_rejected(result, RejectReason::kOutsideImage))
          << places[i % 4].transpose() << ", heading " << robot.motion.heading_rad;
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(outside, 100);
}

// A cable, a hand, dirt: with one disc hidden nobody can know the robot, so nobody shall guess.
TEST(DetectorRejections, ARobotWithAHiddenDiscIsNotTakenForAnother) {
  const MarkerLayout layout = bundled_layout("league");
  Renderer renderer(straight_scene(layout, 120, 120, kScale_px_per_m), 1);
  const PixelScaleGrid scale = scale_of(renderer.camera(), layout.height_m);
  DiscPatternDetector detector(layout, scale);
  RandomStream random(3);
  DetectionResult result;
  cv::Mat bgr;
  for (int id = 0; id < 16; ++id) {
    for (std::size_t hidden = 0; hidden < 4; ++hidden) {
      for (const cv::Vec3b& patch :
           {cv::Vec3b{5, 5, 5}, kPlate, cv::Vec3b{235, 235, 235}, kBlue, kYellow}) {
        const double heading_rad = random.uniform(0.0, 2.0 * M_PI);
        const PixelPoint place(59.5 + random.uniform(), 59.5 + random.uniform());
        const RobotPlacement robot =
            robot_at(renderer.camera(), layout, place, heading_rad, random.below(2), id);
        renderer.render_robots(id, {&robot, 1}, bgr);
        const Eigen::Vector2d offset_m =
            Eigen::Rotation2Dd(heading_rad) * layout.outer[hidden].position_robot_m;
        fill_disc(bgr, place + kScale_px_per_m * PixelPoint(offset_m.x(), -offset_m.y()),
                  1.15 * kScale_px_per_m * layout.outer[hidden].radius_m, patch);
        detector.detect(bgr, result);
        for (const RobotObservation& seen : result.robots) {
          ADD_FAILURE() << "id " << id << " without disc " << hidden << " is taken for id "
                        << layout.identities[seen.identity].id << ", patch " << patch
                        << ", confidence " << seen.confidence;
        }
      }
    }
  }
}

TEST(DetectorRejections, MoreRobotsThanTheListHoldsAreTooManyCandidates) {
  const MarkerLayout layout = bundled_layout("pair");
  constexpr double kSmallScale_px_per_m = 100.0;
  cv::Mat bgr = flat_picture(640, 480, kPlate);
  for (int i = 0; i < 400; ++i) {
    const cv::Point centre(20 + 30 * (i % 20), 12 + 23 * (i / 20));
    for (int disc = 0; disc < 2; ++disc) {  // squares of 5 pixels: discs enough for this camera
      bgr(cv::Rect(centre.x + 6 * disc - 2, centre.y - 2, 5, 5)).setTo(disc == 0 ? kBlue : kYellow);
    }
  }
  DiscPatternDetector detector(layout, square_grid(640, 480, kSmallScale_px_per_m));
  DetectionResult result;
  detector.detect(bgr, result);
  EXPECT_EQ(result.robots.size(), 256U);
  EXPECT_TRUE(is_rejected(result, RejectReason::kTooManyCandidates));
}

// A picture full of round things in the game's colours: the lists stay as long as they were
// reserved, and chance makes no robot.
TEST(DetectorRejections, ConfettiIsBoundedAndMakesNoRobots) {
  const MarkerLayout layout = bundled_layout("league");
  DiscPatternDetector detector(layout, square_grid(640, 512));
  RandomStream random(4);
  DetectionResult result;
  detector.detect(flat_picture(640, 512, kPlate), result);
  const RobotObservation* const robots = result.robots.data();
  const RejectedCandidate* const rejected = result.rejected.data();
  std::size_t false_robots = 0;
  for (int round = 0; round < 40; ++round) {
    cv::Mat bgr = flat_picture(640, 512, kPlate);
    const cv::Vec3b colours[] = {kBlue, kYellow, kPink, kGreen, {235, 235, 235}};
    for (int i = 0; i < 1500; ++i) {
      const PixelPoint place(random.uniform(0.0, 640.0), random.uniform(0.0, 512.0));
      const int left = std::max(0, static_cast<int>(place.x()) - 8);
      const int top = std::max(0, static_cast<int>(place.y()) - 8);
      cv::Mat part = bgr(cv::Rect(left, top, std::min(17, 640 - left), std::min(17, 512 - top)));
      fill_disc(part, place - PixelPoint(left, top), random.uniform(4.0, 7.0),
                colours[random.below(5)]);
    }
    detector.detect(bgr, result);
    false_robots += result.robots.size();
    EXPECT_LE(result.rejected.size(), 256U);
    EXPECT_GT(result.rejected_not_listed, 0);
    EXPECT_EQ(result.robots.data(), robots);
    EXPECT_EQ(result.rejected.data(), rejected);
  }
  EXPECT_EQ(false_robots, 0U);
}

TEST(DetectorRejections, PixelNoiseInAllColoursMakesNoRobots) {
  const MarkerLayout layout = bundled_layout("league");
  DiscPatternDetector detector(layout, square_grid(640, 512));
  RandomStream random(5);
  cv::Mat bgr(512, 640, CV_8UC3);
  for (int i = 0; i < 3 * 640 * 512; ++i) bgr.data[i] = static_cast<uchar>(random.below(256));
  DetectionResult result;
  detector.detect(bgr, result);
  EXPECT_TRUE(result.robots.empty());
  EXPECT_LE(result.rejected.size(), 256U);
}

TEST(DetectorRejections, DiscsTooSmallToSeeAreAnInputError) {
  const MarkerLayout layout = bundled_layout("league");
  const std::string line =
      input_error_line([&] { DiscPatternDetector(layout, square_grid(640, 480, 50.0)); });
  EXPECT_NE(line.find("league"), std::string::npos) << line;
  EXPECT_NE(line.find("radius of 1.00"), std::string::npos) << line;
  EXPECT_NE(line.find("closer camera"), std::string::npos) << line;
}

TEST(DetectorRejections, AFrameOfAnotherSizeOrTypeIsRefused) {
  DiscPatternDetector detector(bundled_layout("pair"), square_grid(120, 90));
  DetectionResult result;
  for (const cv::Mat& bgr :
       {cv::Mat(), flat_picture(119, 90, kPlate), flat_picture(120, 91, kPlate),
        cv::Mat(90, 120, CV_8UC1, cv::Scalar(0)), cv::Mat(90, 120, CV_8UC4, cv::Scalar::all(0))}) {
    EXPECT_THROW(detector.detect(bgr, result), std::invalid_argument);
  }
  detector.detect(flat_picture(120, 90, kPlate), result);
  EXPECT_TRUE(result.robots.empty());
}

}  // namespace
}  // namespace nadir::vision
