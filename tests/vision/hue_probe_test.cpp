#include "vision/hue_probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/vision/detector_test_scenes.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr double kScale_px_per_m = 200.0;

cv::Mat confetti(int width_px, int height_px) {
  cv::Mat bgr(height_px, width_px, CV_8UC3);
  RandomStream random(1);
  for (int i = 0; i < 3 * width_px * height_px; ++i) {
    bgr.data[i] = static_cast<uchar>(random.below(256));
  }
  return bgr;
}

// Against the scores themselves, one place after the other.
TEST(HueProbe, GivesTheBestScoreOfTheNearestPixel) {
  const cv::Mat bgr = confetti(61, 47);
  const LocalScale scale = square_scale(kScale_px_per_m);
  const Bgr surroundings(50.0F, 70.0F, 60.0F);
  std::vector<ColourScore> scores;
  for (const Colour colour : {Colour::kPink, Colour::kGreen, Colour::kWhite}) {
    scores.push_back(colour_score(default_colour_classes(), colour, 1.0));
  }
  std::vector<Eigen::Vector2f> offsets_m;
  for (int i = 0; i < 29; ++i)
    offsets_m.emplace_back(0.003F * i - 0.04F, 0.1F * std::sin(1.0F * i));
  HueProbe probe(offsets_m, scores);
  const PixelPoint centre(30.25, 23.25);
  const std::vector<float>& hues = probe.look(bgr, scale, centre, surroundings);
  ASSERT_EQ(hues.size(), offsets_m.size());
  for (std::size_t i = 0; i < offsets_m.size(); ++i) {
    const Eigen::Vector2d at =
        centre + kScale_px_per_m * Eigen::Vector2d(offsets_m[i].x(), -offsets_m[i].y());
    const auto pixel = bgr.at<cv::Vec3b>(static_cast<int>(std::lround(at.y())),
                                         static_cast<int>(std::lround(at.x())));
    float best = -1e9F;
    for (const ColourScore& score : scores) {
      best = std::max(best, score(Bgr(pixel[0], pixel[1], pixel[2]) - surroundings));
    }
    EXPECT_NEAR(hues[i], best, 1e-3) << i;
  }
}

TEST(HueProbe, TellsWhatIsOutsideTheImage) {
  const cv::Mat bgr = confetti(40, 30);
  const LocalScale scale = square_scale(kScale_px_per_m);
  HueProbe probe({{0.0F, 0.0F}, {0.05F, 0.0F}, {-0.05F, 0.0F}, {0.0F, 0.05F}, {0.0F, -0.05F}},
                 {colour_score(default_colour_classes(), Colour::kPink, 1.0)});
  const auto outside = [&](const PixelPoint& centre) {
    std::vector<bool> flags;
    for (const float hue : probe.look(bgr, scale, centre, Bgr::Zero())) {
      flags.push_back(hue < 0.5F * HueProbe::kOutside);
    }
    return flags;
  };
  using Flags = std::vector<bool>;
  EXPECT_EQ(outside({20.0, 15.0}), (Flags{false, false, false, false, false}));
  EXPECT_EQ(outside({39.0, 29.0}), (Flags{false, true, false, false, true}));
  EXPECT_EQ(outside({0.0, 0.0}), (Flags{false, false, true, true, false}));
  EXPECT_EQ(outside({29.1, 15.0}), (Flags{false, true, false, false, false}));
}

}  // namespace
}  // namespace nadir::vision
