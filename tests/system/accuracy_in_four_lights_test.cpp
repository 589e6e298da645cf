// The promise of README: every robot found, named rightly and placed within a few hundredths of a
// pixel in four lights, with default colours, and a covariance that holds. 200 frames a case, all
// robots redrawn in every frame.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <ostream>
#include <string>

#include "tests/support/accuracy_study.h"
#include "vision/synthetic/scene.h"

namespace nadir::support {
namespace {

constexpr int kFrames = 200;
constexpr std::uint64_t kSeed = 20;

struct Case {
  const char* scene;
  bool even_light;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.scene; }

class FourLights : public testing::TestWithParam<Case> {};

AccuracyStudy study(const char* scene_name, bool exact_camera) {
  vision::Scene scene = vision::load_scene(std::filesystem::path(NADIR_DATA_DIR) / "scenes" /
                                           (std::string(scene_name) + ".yaml"));
  if (exact_camera) {  // straight down and without distortion: polynomial2 fits exactly
    scene.camera.tilt_rad = scene.camera.k1 = scene.camera.k2 = 0.0;
  }
  return study_accuracy(scene, kSeed, kFrames);
}

void record(const AccuracyStudy& result) {
  std::printf(
      "found %.4f, wrong names %llu, false %llu, centre RMS %.4f %.4f px, bias %+.4f %+.4f px, "
      "heading RMS %.4f "
      "deg, NEES %.2f\n",
      result.found_share(), static_cast<unsigned long long>(result.wrong_names),
      static_cast<unsigned long long>(result.false_robots), result.centre_rms_px().x(),
      result.centre_rms_px().y(), result.centre_bias_px().x(), result.centre_bias_px().y(),
      result.heading_rms_deg(), result.mean_nees());
}

TEST_P(FourLights, EveryRobotIsFoundNamedAndPlaced) {
  const AccuracyStudy result = study(GetParam().scene, false);
  record(result);
  EXPECT_GE(result.found_share(), 0.999);
  EXPECT_EQ(result.wrong_names, 0U);
  EXPECT_EQ(result.false_robots, 0U);
  const bool league = std::string(GetParam().scene).starts_with("league");
  const double limit_px = GetParam().even_light ? 0.04 : 0.12;
  EXPECT_LE(result.centre_rms_px().maxCoeff(), limit_px);
  EXPECT_LE(result.centre_bias_px().cwiseAbs().maxCoeff(), 0.02);
  if (league && GetParam().even_light) {
    EXPECT_LE(result.heading_rms_deg(), 0.15);
  }
  EXPECT_GE(result.mean_nees(), 2.0);
  EXPECT_LE(result.mean_nees(), 4.5);
}

// With a lens that the polynomial fits exactly nothing but the pixels' own noise is left: the
// variances from the pixel counts stand alone.
TEST_P(FourLights, CovarianceHoldsWithAnExactCalibration) {
  const AccuracyStudy result = study(GetParam().scene, true);
  record(result);
  EXPECT_GE(result.mean_nees(), 2.0);
  EXPECT_LE(result.mean_nees(), 4.5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, FourLights,
                         testing::Values(Case{"league_even", true}, Case{"league_bayer", false},
                                         Case{"league_dim_warm", false},
                                         Case{"league_shadow", false}, Case{"pair_even", true},
                                         Case{"pair_bayer", false}, Case{"pair_dim_warm", false},
                                         Case{"pair_shadow", false}),
                         [](const auto& test) { return std::string(test.param.scene); });

TEST(FarCamera, MarkersOfEightToTwentyPixelsAreFound) {
  const AccuracyStudy result = study("pair_far", true);
  record(result);
  EXPECT_GE(result.found_share(), 0.99);
  EXPECT_EQ(result.false_robots, 0U);
  EXPECT_LE(result.centre_rms_px().maxCoeff(), 0.01);
  EXPECT_LE(result.heading_rms_deg(), 0.13);
  EXPECT_GE(result.mean_nees(), 2.0);
  EXPECT_LE(result.mean_nees(), 4.5);
}

// Sums over several sizes: of each size alone the pixel grid favours some and not others. The
// variance of the heading may be careful, but not by more than a few times.
TEST(FarCamera, CovarianceHoldsFromEightToTwentyPixelsAMark) {
  const vision::Scene far =
      vision::load_scene(std::filesystem::path(NADIR_DATA_DIR) / "scenes" / "pair_far.yaml");
  const vision::MarkerLayout& layout = far.layouts.front();
  for (const auto mosaic :
       {vision::SceneSensor::Mosaic::kNone, vision::SceneSensor::Mosaic::kRggb}) {
    AccuracyStudy all;
    for (const double pixels : {8.0, 10.0, 12.0, 14.0, 17.0, 20.0}) {
      vision::Scene scene = far;
      scene.sensor.mosaic = mosaic;
      scene.camera.tilt_rad = scene.camera.k1 = 0.0;
      scene.camera.focal_px = std::sqrt(pixels / std::numbers::pi) / layout.centre_radius_m *
                              (scene.camera.height_m - layout.height_m);
      const AccuracyStudy one = study_accuracy(scene, kSeed, 50);
      all.robots += one.robots;
      all.false_robots += one.false_robots;
      all.errors.insert(all.errors.end(), one.errors.begin(), one.errors.end());
    }
    double published_rad2 = 0.0;
    double measured_rad2 = 0.0;
    for (const PoseError& error : all.errors) {
      published_rad2 += error.covariance(2, 2);
      measured_rad2 += error.pose.z() * error.pose.z();
    }
    record(all);
    std::printf("heading variance published over measured %.2f\n", published_rad2 / measured_rad2);
    EXPECT_GE(all.found_share(), 0.99);
    EXPECT_LE(all.false_robots, all.robots / 1000);
    EXPECT_GE(all.mean_nees(), 2.0);
    EXPECT_LE(all.mean_nees(), 4.5);
    EXPECT_GE(published_rad2 / measured_rad2, 0.7);
    EXPECT_LE(published_rad2 / measured_rad2, 5.0);
  }
}

}  // namespace
}  // namespace nadir::support
