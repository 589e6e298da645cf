// Tags drawn at known pixels, and those of real photographs.

#include "vision/tag_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "tests/calibration/picture_drawing.h"

namespace nadir::vision {
namespace {

/// 2.5 mm/px, (0, 0) in the middle of a picture of 320x240, slightly turned.
Eigen::Vector2d turned_camera(const PixelPoint& pixel) {
  const double u = pixel.x() - 160.0;
  const double v = pixel.y() - 120.0;
  return {0.0025 * (std::cos(0.1) * u - std::sin(0.1) * v),
          -0.0025 * (std::sin(0.1) * u + std::cos(0.1) * v)};
}

TEST(TagDetector, FindsCentresInOurPixels) {
  const std::vector<calibration::DrawnTag> placed = {
      {3, {-0.2, 0.1}}, {17, {0.2, 0.15}}, {42, {0.05, -0.12}}, {585, {-0.22, -0.15}}};
  const auto picture =
      calibration::drawn_picture({320, 240}, turned_camera, calibration::tags(placed, 0.1), 21);
  TagDetector detector;
  const auto found = detector.detect(picture);
  ASSERT_EQ(found.size(), placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_EQ(found[i].id, placed[i].id);
    EXPECT_EQ(found[i].corrected_bits, 0);
    const PixelPoint pixel =
        calibration::pixel_of(turned_camera, placed[i].place_m, {160.0, 120.0});
    EXPECT_LT((found[i].centre_px - pixel).norm(), 0.12) << found[i].id;
    // Corners around it; the tag's x axis is that of the field.
    const Eigen::Vector2d right_m =
        turned_camera(found[i].corners_px[1]) - turned_camera(found[i].corners_px[0]);
    EXPECT_NEAR(right_m.x(), 0.1, 0.002);
    EXPECT_NEAR(right_m.y(), 0.0, 0.002);
  }
  // A grey picture is the same; one that is too small is no crash.
  std::vector<cv::Mat> channels;
  cv::Mat grey(picture.size(), CV_8UC1);
  cv::extractChannel(picture, grey, 0);
  EXPECT_EQ(detector.detect(grey).size(), placed.size());
  EXPECT_TRUE(detector.detect(cv::Mat(3, 3, CV_8UC3, cv::Scalar(0, 0, 0))).empty());
  // A view into a larger picture.
  const cv::Rect part(0, 0, 160, 120);
  const auto in_part = detector.detect(picture(part));
  ASSERT_EQ(in_part.size(), 1U);
  EXPECT_EQ(in_part[0].id, 3);
}

TEST(TagDetector, RefusesAFamilyThatItDoesNotKnow) {
  EXPECT_THROW(TagDetector("tag99"), std::invalid_argument);
  for (const std::string& family : tag_families()) EXPECT_NO_THROW(TagDetector{family});
}

struct Reference {
  int id = 0;
  std::array<PixelPoint, 4> corners_px;
};

std::vector<Reference> read_references(const std::filesystem::path& file) {
  std::vector<Reference> references;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    for (char& c : line) {
      if (c == ',' || c == '(' || c == ')') c = ' ';
    }
    std::istringstream words(line);
    Reference reference;
    if (!(words >> reference.id)) continue;
    for (PixelPoint& corner : reference.corners_px) {
      words >> corner.x() >> corner.y();
      corner -= PixelPoint(0.5, 0.5);  // as libapriltag counts
    }
    references.push_back(reference);
  }
  return references;
}

// Every corner of the reference has one of the tag's within 0.2 px.
bool agree(const TagObservation& tag, const Reference& reference) {
  return tag.id == reference.id &&
         std::ranges::all_of(reference.corners_px, [&](const PixelPoint& corner) {
           return std::ranges::any_of(
               tag.corners_px, [&](const PixelPoint& own) { return (own - corner).norm() < 0.2; });
         });
}

TEST(TagDetector, FindsTheTagsOfRealPhotographs) {
  const std::filesystem::path folder = std::filesystem::path(NADIR_REAL_DIR) / "apriltag";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  TagDetector thorough({*find_tag_family("36h11")}, 1.0, TagReading::kThorough);
  TagDetector careful;
  std::size_t expected = 0;
  std::size_t by_careful = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt") continue;
    auto photograph = entry.path();
    // The reference was made of the luminance that the file holds.
    const cv::Mat picture =
        cv::imread(photograph.replace_extension(".jpg").string(), cv::IMREAD_GRAYSCALE);
    const auto found = thorough.detect(picture);
    const auto references = read_references(entry.path());
    EXPECT_EQ(found.size(), references.size()) << photograph;  // none that is not there
    for (const Reference& reference : references) {
      EXPECT_TRUE(std::ranges::any_of(
          found, [&](const TagObservation& tag) { return agree(tag, reference); }))
          << photograph << ", tag " << reference.id;
    }
    expected += references.size();
    by_careful += careful.detect(picture).size();
  }
  EXPECT_EQ(expected, 47U);
  EXPECT_GE(by_careful, 45U);
  EXPECT_LE(by_careful, 47U);
}

}  // namespace
}  // namespace nadir::vision
