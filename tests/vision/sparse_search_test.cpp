#include "vision/sparse_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "tests/vision/detector_test_scenes.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr double kHueHalfWidth_rad = 0.87;  // as in the detector
constexpr double kScale_px_per_m = 250.0;

std::vector<ColourScore> scores_of(const std::vector<Colour>& colours) {
  std::vector<ColourScore> scores;
  for (const Colour colour : colours) {
    scores.push_back(colour_score(default_colour_classes(), colour, kHueHalfWidth_rad));
  }
  return scores;
}

std::vector<Seed> seeds_in(SparseSearch& search, const cv::Mat& bgr) {
  search.scan(bgr);
  std::vector<Seed> seeds;
  search.for_each_seed([&](const Seed& seed, const PixelPoint&) { seeds.push_back(seed); });
  return seeds;
}

// One disc of each colour on a plate a little wider than what the search calls its surroundings.
class EveryDisc : public testing::TestWithParam<double> {};

TEST_P(EveryDisc, GivesASeedOfItsColourAtEverySubPixelPlace) {
  const double radius_px = GetParam();
  const std::vector<Colour> colours = {Colour::kYellow, Colour::kBlue,   Colour::kPink,
                                       Colour::kGreen,  Colour::kOrange, Colour::kWhite};
  const int size_px = 32 + static_cast<int>(8.0 * radius_px);
  for (std::size_t team = 0; team < colours.size(); ++team) {
    MarkerLayout layout = lone_disc_layout(radius_px / kScale_px_per_m, colours[team]);
    Scene scene = straight_scene(layout, size_px, size_px, kScale_px_per_m);
    scene.bodies[0].radius_m = scene.bodies[0].front_m = 3.0 * layout.centre_radius_m;
    Renderer renderer(scene, 1);
    SparseSearch search(size_px, size_px, radius_px, radius_px, scores_of(colours));
    RandomStream random(7, team);
    cv::Mat bgr;
    for (int i = 0; i < 120; ++i) {
      const PixelPoint place =
          PixelPoint::Constant(0.5 * size_px) +
          radius_px * PixelPoint(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
      const RobotPlacement robot = robot_at(renderer.camera(), layout, place);
      renderer.render_robots(0, {&robot, 1}, bgr);
      int in_disc = 0;
      for (const Seed& seed : seeds_in(search, bgr)) {
        const bool inside = (seed.pixel - place).norm() < radius_px;
        in_disc += inside && seed.colour == static_cast<int>(team) ? 1 : 0;
      }
      EXPECT_GT(in_disc, 0) << colour_name(colours[team]) << " at " << place.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, EveryDisc,
                         testing::Values(1.5, 1.9, 2.5, 3.7, 5.0, 7.5, 11.0, 15.0));

// The calibration says how much the scale differs over the image: one search serves all of it.
TEST(SparseSearch, OneGridFindsDiscsOfEveryRadiusInItsRange) {
  const std::vector<ColourScore> scores = scores_of({Colour::kBlue});
  SparseSearch search(160, 160, 4.0, 8.0, scores);
  RandomStream random(3);
  for (int i = 0; i < 400; ++i) {
    cv::Mat bgr = flat_picture(160, 160, {40, 40, 40});
    const PixelPoint place(random.uniform(40.0, 120.0), random.uniform(40.0, 120.0));
    const double radius_px = random.uniform(4.0, 8.0);
    fill_disc(bgr, place, radius_px, {230, 140, 30});
    bool found = false;
    for (const Seed& seed : seeds_in(search, bgr)) {
      found = found || (seed.pixel - place).norm() < radius_px;
    }
    EXPECT_TRUE(found) << radius_px << " at " << place.transpose();
  }
}

TEST(SparseSearch, ABlackDiscOnABrightPlateGivesASeed) {
  SparseSearch search(100, 100, 5.0, 5.0, scores_of({Colour::kBlack}));
  RandomStream random(4);
  for (const double light : {0.3, 0.6, 1.0}) {
    const auto grey = [light](double share) { return static_cast<uchar>(240.0 * light * share); };
    for (int i = 0; i < 100; ++i) {
      cv::Mat bgr = flat_picture(100, 100, {grey(0.7), grey(0.8), grey(0.75)});
      const PixelPoint place(random.uniform(20.0, 80.0), random.uniform(20.0, 80.0));
      fill_disc(bgr, place, 5.0, {grey(0.05), grey(0.05), grey(0.05)});
      bool found = false;
      for (const Seed& seed : seeds_in(search, bgr)) {
        found = found || (seed.pixel - place).norm() < 5.0;
      }
      EXPECT_TRUE(found) << "light " << light << " at " << place.transpose();
    }
  }
}

TEST(SparseSearch, DarkAndGreyDiscsAreNoSeedsOfAnyHue) {
  SparseSearch search(
      100, 100, 5.0, 5.0,
      scores_of({Colour::kYellow, Colour::kBlue, Colour::kPink, Colour::kGreen, Colour::kOrange}));
  for (const uchar grey : {0, 12, 60, 140, 255}) {
    cv::Mat bgr = flat_picture(100, 100, {190, 190, 190});
    fill_disc(bgr, {50.3, 49.8}, 5.0, {grey, grey, grey});
    EXPECT_TRUE(seeds_in(search, bgr).empty()) << static_cast<int>(grey);
  }
}

TEST(SparseSearch, FloorsOfOneColourGiveNoSeeds) {
  SparseSearch search(203, 151, 5.0, 6.0,
                      scores_of({Colour::kYellow, Colour::kBlue, Colour::kWhite, Colour::kBlack}));
  for (const cv::Vec3b& floor :
       {cv::Vec3b{30, 210, 240}, cv::Vec3b{220, 110, 30}, cv::Vec3b{240, 240, 240},
        cv::Vec3b{10, 10, 10}, cv::Vec3b{0, 0, 0}, cv::Vec3b{45, 100, 60}}) {
    EXPECT_TRUE(seeds_in(search, flat_picture(203, 151, floor)).empty()) << floor;
  }
}

TEST(SparseSearch, AGradientOfAWantedHueGivesNoSeeds) {
  SparseSearch search(320, 240, 5.0, 6.0, scores_of({Colour::kBlue, Colour::kWhite}));
  for (const bool across : {false, true}) {
    cv::Mat bgr(240, 320, CV_8UC3);
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const double light = across ? 0.3 + 0.7 * v / 239.0 : 0.3 + 0.7 * u / 319.0;
        bgr.at<cv::Vec3b>(v, u) = {static_cast<uchar>(230 * light), static_cast<uchar>(140 * light),
                                   static_cast<uchar>(30 * light)};
      }
    }
    EXPECT_TRUE(seeds_in(search, bgr).empty());
  }
}

// Lines wider than a disc: only their ends look like one from some grid points.
TEST(SparseSearch, WideLinesGiveHardlyASeed) {
  SparseSearch search(320, 240, 5.0, 5.0, scores_of({Colour::kWhite}));
  const std::size_t grid_points = (320 / 3) * (240 / 5);
  for (int angle = 0; angle < 180; angle += 15) {
    cv::Mat bgr = flat_picture(320, 240, {45, 100, 60});
    const PixelPoint normal(std::sin(angle * M_PI / 180.0), -std::cos(angle * M_PI / 180.0));
    std::size_t on_line = 0;
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        if (std::abs(normal.dot(PixelPoint(u - 160.0, v - 120.0))) > 12.0) continue;
        bgr.at<cv::Vec3b>(v, u) = {225, 225, 225};
        ++on_line;
      }
    }
    EXPECT_LE(seeds_in(search, bgr).size(), on_line * grid_points / (320 * 240) / 25) << angle;
  }
}

TEST(SparseSearch, MarkedPlacesAreNoSeedsOfThatColour) {
  cv::Mat bgr = flat_picture(120, 90, {40, 40, 40});
  const PixelPoint first(30.2, 40.7);
  const PixelPoint second(80.4, 50.1);
  fill_disc(bgr, first, 6.0, {230, 140, 30});
  fill_disc(bgr, second, 6.0, {230, 140, 30});
  SparseSearch search(120, 90, 6.0, 6.0, scores_of({Colour::kBlue, Colour::kBlue}));
  search.scan(bgr);
  search.mark(first, 8.0, 0);
  int of_first[2] = {0, 0};
  int of_second[2] = {0, 0};
  search.for_each_seed([&](const Seed& seed, const PixelPoint&) {
    ++((seed.pixel - first).norm() < 7.0 ? of_first : of_second)[seed.colour];
  });
  EXPECT_EQ(of_first[0], 0);
  EXPECT_GT(of_first[1], 0);
  EXPECT_GT(of_second[0], 0);
  EXPECT_GT(of_second[1], 0);
  // A mark made while the seeds are visited counts at once, and the next scan forgets it.
  for (int scan = 0; scan < 2; ++scan) {
    search.scan(bgr);
    int visits = 0;
    search.for_each_seed([&](const Seed& seed, const PixelPoint&) {
      ++visits;
      search.mark(seed.pixel, 20.0, seed.colour);
    });
    EXPECT_EQ(visits, 4);
  }
}

// Bands may come in any order and overlap; the next scan of everything sees everything.
TEST(SparseSearch, ListsOnlySeedsOfTheBandsThatItLooksAt) {
  cv::Mat bgr = flat_picture(120, 200, {40, 40, 40});
  const std::vector<PixelPoint> discs = {{30.2, 20.7}, {60.6, 90.4}, {80.4, 160.1}};
  for (const PixelPoint& disc : discs) fill_disc(bgr, disc, 6.0, {230, 140, 30});
  SparseSearch search(120, 200, 6.0, 6.0, scores_of({Colour::kBlue}));
  const auto seen = [&](std::span<const RowBand> bands) {
    search.scan(bgr, bands);
    std::array<bool, 3> result{};
    search.for_each_seed([&](const Seed& seed, const PixelPoint&) {
      for (std::size_t i = 0; i < discs.size(); ++i) {
        result[i] = result[i] || (seed.pixel - discs[i]).norm() < 7.0;
      }
    });
    return result;
  };
  const std::array<RowBand, 3> ends = {{{140, 1000}, {150, 170}, {-20, 40}}};
  EXPECT_EQ(seen(ends), (std::array{true, false, true}));
  const std::array<RowBand, 1> middle = {{{80, 100}}};
  EXPECT_EQ(seen(middle), (std::array{false, true, false}));
  EXPECT_EQ(seen({}), (std::array{false, false, false}));
  EXPECT_EQ(seen(std::array<RowBand, 1>{}), (std::array{true, true, true}));
}

// The second place is that of the disc that comes next, not that of another point of the same disc.
TEST(SparseSearch, TellsWhereItLooksNext) {
  cv::Mat bgr = flat_picture(200, 90, {40, 40, 40});
  const std::vector<PixelPoint> discs = {{30.2, 20.7}, {150.6, 24.4}, {80.4, 60.1}};
  for (const PixelPoint& disc : discs) fill_disc(bgr, disc, 6.0, {230, 140, 30});
  SparseSearch search(200, 90, 6.0, 6.0, scores_of({Colour::kBlue}));
  search.scan(bgr);
  std::size_t visits = 0;
  search.for_each_seed([&](const Seed& seed, const PixelPoint& next) {
    ASSERT_LT(visits, discs.size());
    EXPECT_LT((seed.pixel - discs[visits]).norm(), 6.0);
    if (visits + 1 < discs.size()) {
      EXPECT_LT((next - discs[visits + 1]).norm(), 7.0);
    }
    search.mark(discs[visits], 8.0, seed.colour);
    ++visits;
  });
  EXPECT_EQ(visits, discs.size());
}

TEST(SparseSearch, MarksBeyondTheImageAreHarmless) {
  SparseSearch search(50, 40, 3.0, 3.0, scores_of({Colour::kBlue}));
  search.scan(flat_picture(50, 40, {40, 40, 40}));
  for (const PixelPoint& place : {PixelPoint(-10.0, 5.0), PixelPoint(60.0, 50.0),
                                  PixelPoint(0.0, 0.0), PixelPoint(49.0, 39.0)}) {
    search.mark(place, 30.0, 0);
    search.mark(place, 0.0, 0);
  }
  search.for_each_seed(
      [](const Seed&, const PixelPoint&) { ADD_FAILURE() << "a flat floor has no seeds"; });
}

// Sizes that are no multiples of the grid's steps, down to a single pixel, with grids finer and
// coarser than the image; discs cut by each border.
TEST(SparseSearch, EveryImageSizeIsSafe) {
  const std::vector<ColourScore> scores = scores_of({Colour::kBlue, Colour::kWhite});
  for (const double radius_px : {1.2, 3.0, 5.0, 15.0, 60.0}) {
    for (int width_px = 1; width_px < 40; width_px += 3) {
      for (const int height_px : {1, 2, 5, 18, 33}) {
        SparseSearch search(width_px, height_px, radius_px, 1.3 * radius_px, scores);
        cv::Mat bgr = flat_picture(width_px, height_px, {40, 40, 40}).clone();
        fill_disc(bgr, PixelPoint(width_px - 1.0, height_px - 1.0), radius_px, {230, 140, 30});
        fill_disc(bgr, PixelPoint(0.0, 0.0), radius_px, {230, 230, 230});
        for (const Seed& seed : seeds_in(search, bgr)) {
          EXPECT_TRUE(seed.pixel.allFinite());
          EXPECT_GE(seed.pixel.minCoeff(), -1.1 * radius_px);
          EXPECT_LE(seed.pixel.x(), width_px + 0.6 * radius_px);
          EXPECT_LE(seed.pixel.y(), height_px + 1.1 * radius_px);
        }
      }
    }
  }
}

// The grid's last column lies on the image's last one, and a disc there is seen.
TEST(SparseSearch, ADiscInTheLastColumnAndRowGivesASeed) {
  const double radius_px = 5.0;  // columns from 1 in steps of 3, rows from 2 in steps of 5
  for (int width_px = 60; width_px < 64; ++width_px) {
    SparseSearch search(width_px, 58, radius_px, radius_px, scores_of({Colour::kBlue}));
    const PixelPoint place(width_px - 1.0 - radius_px, 57.0 - radius_px);
    cv::Mat bgr = flat_picture(width_px, 58, {40, 40, 40});
    fill_disc(bgr, place, radius_px, {230, 140, 30});
    EXPECT_FALSE(seeds_in(search, bgr).empty()) << width_px;
  }
}

}  // namespace
}  // namespace nadir::vision
