// Loops that look at eight pixels at a time with the processor's widest registers give the poses of
// a plain build.

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/calibration_height.h"
#include "tests/tracker/kernel_poses.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::tracker {
namespace {

constexpr double kSame_m = 1e-6;
constexpr double kSame_rad = 1e-6;

// Guesses are a third of a pixel and a degree off.
std::vector<kernels::Picture> pictures_of(SyntheticCamera& camera, int frames) {
  vision::RandomStream random(5, 0, 77);
  std::vector<kernels::Picture> pictures;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    kernels::Picture& picture = pictures.emplace_back();
    picture.image = rendered_frame(camera.renderer, number).image;
    for (const vision::RobotTruth& robot : camera.renderer.truth(number)) {
      picture.guesses.push_back(
          {robot.id,
           {robot.x_m + 0.001 * random.normal(), robot.y_m + 0.001 * random.normal(),
            robot.heading_rad + 0.02 * random.normal()},
           {robot.u_px, robot.v_px}});
    }
  }
  return pictures;
}

class PlainKernels : public testing::TestWithParam<const char*> {};

TEST_P(PlainKernels, GiveTheSamePoses) {
  SyntheticCamera camera = synthetic_camera(GetParam(), 8);
  const std::vector<kernels::Picture> pictures = pictures_of(camera, 4);
  const bool mosaic = std::string(GetParam()).find("bayer") != std::string::npos;
  const vision::MarkerLayout& layout = camera.setup.layouts.front();
  const calibration::PlaneMap map =
      calibration::map_at_height(camera.setup.calibration, layout.height_m);
  const kernels::Poses usual = kernels::usual_poses(layout, map, mosaic, pictures);
  const kernels::Poses plain = kernels::plain_poses(layout, map, mosaic, pictures);
  ASSERT_EQ(usual.size(), plain.size());
  ASSERT_GE(usual.size(), 8U);
  int found = 0;
  int equal = 0;
  for (std::size_t i = 0; i < usual.size(); ++i) {
    ASSERT_EQ(std::isnan(usual[i][0]), std::isnan(plain[i][0])) << i;
    if (std::isnan(usual[i][0])) continue;
    ++found;
    equal += usual[i] == plain[i] ? 1 : 0;
    EXPECT_NEAR(usual[i][0], plain[i][0], kSame_m) << i;
    EXPECT_NEAR(usual[i][1], plain[i][1], kSame_m) << i;
    EXPECT_NEAR(fusion::wrap_angle(usual[i][2] - plain[i][2]), 0.0, kSame_rad) << i;
  }
  EXPECT_GE(found, static_cast<int>(0.9 * static_cast<double>(usual.size())));
  EXPECT_LT(equal, found);  // they are two builds indeed: sums of floats come in another order
}

INSTANTIATE_TEST_SUITE_P(Scenes, PlainKernels,
                         testing::Values("league_even", "league_bayer", "pair_shadow",
                                         "tags_even"));

}  // namespace
}  // namespace nadir::tracker
