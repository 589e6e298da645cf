#include "vision/mosaic_trace.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "tests/vision/detector_test_scenes.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

using Mosaic = SceneSensor::Mosaic;
constexpr Mosaic kPhases[] = {Mosaic::kRggb, Mosaic::kBggr, Mosaic::kGrbg, Mosaic::kGbrg};

Scene league_scene(Mosaic mosaic) {
  Scene scene = load_scene(std::filesystem::path(NADIR_DATA_DIR) / "scenes" / "league_even.yaml");
  scene.sensor.mosaic = mosaic;
  return scene;
}

int found_in(const Scene& scene, int frames) {
  Renderer renderer(scene, 3);
  cv::Mat bgr;
  int found = 0;
  for (int frame = 0; frame < frames; ++frame) {
    renderer.render(frame, bgr);
    found += looks_demosaiced(bgr) ? 1 : 0;
  }
  return found;
}

TEST(MosaicTrace, IsSeenInEveryPhaseBrightAndDim) {
  for (const Mosaic phase : kPhases) {
    Scene scene = league_scene(phase);
    EXPECT_EQ(found_in(scene, 10), 10);
    scene.light.level = 0.4;
    scene.light.colour = {0.7F, 1.0F, 1.2F};
    EXPECT_EQ(found_in(scene, 10), 10);
  }
}

TEST(MosaicTrace, FramesWithoutAMosaicHaveNone) {
  Scene scene = league_scene(Mosaic::kNone);
  EXPECT_EQ(found_in(scene, 20), 0);
  scene.light.level = 0.4;
  EXPECT_EQ(found_in(scene, 20), 0);
}

TEST(MosaicTrace, PlainNoiseIsHardlyEverTakenForIt) {
  RandomStream random(8);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    cv::Mat bgr(120, 160, CV_8UC3);
    for (int v = 0; v < bgr.rows; ++v) {
      for (int u = 0; u < bgr.cols; ++u) {
        bgr.at<cv::Vec3b>(v, u)[1] = cv::saturate_cast<uchar>(90.0 + 2.0 * random.normal());
      }
    }
    found += looks_demosaiced(bgr) ? 1 : 0;
  }
  EXPECT_EQ(found, 0);
}

TEST(MosaicTrace, FlatFramesAndTinyOnesTellNothing) {
  EXPECT_FALSE(looks_demosaiced(flat_picture(640, 480, {40, 90, 60})));
  EXPECT_FALSE(looks_demosaiced(flat_picture(640, 480, {0, 0, 0})));
  for (const int size_px : {1, 2, 3, 15, 23, 24, 25}) {
    EXPECT_FALSE(looks_demosaiced(flat_picture(size_px, size_px, {40, 90, 60})));
  }
}

TEST(MosaicTrace, JpegWipesItOut) {
  for (const Mosaic phase : kPhases) {
    Renderer renderer(league_scene(phase), 3);
    cv::Mat bgr;
    renderer.render(0, bgr);
    std::vector<uchar> bytes;
    ASSERT_TRUE(cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, 80}));
    EXPECT_FALSE(looks_demosaiced(cv::imdecode(bytes, cv::IMREAD_COLOR)));
  }
}

}  // namespace
}  // namespace nadir::vision
