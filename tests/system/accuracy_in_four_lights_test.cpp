// The promise of README: every robot found, named rightly and placed within a few hundredths of a
// pixel in four lights, with default colours, and a covariance that holds. 200 frames a case, all
// robots redrawn in every frame.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
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
  EXPECT_GE(result.mean_nees(), 2.0);
  EXPECT_LE(result.mean_nees(), 4.5);
}

}  // namespace
}  // namespace nadir::support
