// Files with random damage: refused with one line, or fitted soundly; never a crash. A bounded
// stand-in for the fuzzers of tests/calibration/fuzz, which need clang.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "calibration/calibration_file.h"
#include "tests/calibration/camera_points.h"
#include "tests/calibration/fuzz/fuzzed_input.h"
#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

std::string points_text(const FieldPoints& points) {
  std::string text = "u_px,v_px,x_m,y_m\n";
  for (const FieldPoint& point : points.points) {
    text += std::to_string(point.pixel.x()) + "," + std::to_string(point.pixel.y()) + "," +
            std::to_string(point.position_m.x()) + "," + std::to_string(point.position_m.y()) +
            "\n";
  }
  return text;
}

/// One to three slips: a character changed, a piece left out, doubled or moved.
std::string damaged(std::string text, std::mt19937_64& random) {
  const std::string characters = "0123456789-+.eE,:[]{}\n \"#nax";
  const auto below = [&random](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  for (std::size_t slips = 1 + below(3); slips > 0; --slips) {
    const std::size_t at = below(text.size());
    const std::size_t length = std::min(text.size() - at, 1 + below(40));
    switch (below(4)) {
      case 0:
        text[at] = characters[below(characters.size())];
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      default:
        text.insert(below(text.size()), text.substr(at, length));
        break;
    }
    if (text.empty()) text = "\n";
  }
  return text;
}

TEST(DamagedInput, PointsAreFittedSoundlyOrRefused) {
  std::mt19937_64 random(201);
  const std::string whole =
      points_text(with_noise(survey(experiment_camera(-0.1), 6, 5), 0.2, 0.001, random));
  ASSERT_TRUE(fits_points(whole));
  int fitted = 0;
  for (int run = 0; run < 40; ++run) fitted += fits_points(damaged(whole, random)) ? 1 : 0;
  EXPECT_GT(fitted, 0);
  EXPECT_LT(fitted, 40);
}

TEST(DamagedInput, CalibrationsAreReadSoundlyOrRefused) {
  std::mt19937_64 random(202);
  for (const ModelKind model : {ModelKind::kPolynomial2, ModelKind::kRadial2}) {
    const FieldPoints points =
        with_noise(survey(experiment_camera(-0.1), 6, 5), 0.2, 0.001, random);
    const FieldFit fit = fit_field(model, points, {});
    const std::string whole = calibration_yaml(
        Calibration{.map = fit.map, .points_box = pixel_box(points), .residuals = fit.residuals});
    ASSERT_TRUE(reads_calibration(whole));
    int read = 0;
    for (int run = 0; run < 300; ++run) read += reads_calibration(damaged(whole, random)) ? 1 : 0;
    EXPECT_GT(read, 0);
    EXPECT_LT(read, 300);
  }
}

TEST(DamagedInput, NothingAtAllIsRefused) {
  for (const char* text : {"", "\n", "u_px,v_px,x_m,y_m", "#\n", "u_px,v_px,x_m\n1,2,3\n", "[]"}) {
    EXPECT_FALSE(fits_points(text));
    EXPECT_FALSE(reads_calibration(text));
  }
}

}  // namespace
}  // namespace nadir::calibration
