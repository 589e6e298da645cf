#include "vision/colour_classes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "vision/synthetic/scene.h"

namespace nadir::vision {
namespace {

constexpr double kHueHalfWidth_rad = 1.0;  // as the identities are read

struct Light {
  const char* name;
  Bgr gain;
};
const Light kLights[] = {{"white", {1.0F, 1.0F, 1.0F}},
                         {"warm", {0.8F, 1.0F, 1.2F}},
                         {"cold", {1.2F, 1.0F, 0.8F}},
                         {"dim", {0.3F, 0.3F, 0.3F}},
                         {"dim and warm", {0.32F, 0.4F, 0.48F}}};

/// A printed mark under a light, less the dark plate around it, as the detector reads colours.
Bgr mark_on_plate(Colour colour, const Light& light) {
  const Reflectance mark = printed_reflectances()[static_cast<std::size_t>(colour)];
  const Reflectance plate = RobotBody{}.colour;
  Bgr difference;
  for (int i = 0; i < 3; ++i) difference[i] = 200.0F * light.gain[i] * (mark[i] - plate[i]);
  return difference;
}

float score(Colour named, const Bgr& value) {
  return colour_score(default_colour_classes(), named, kHueHalfWidth_rad)(value);
}

void expect_own_scores_highest(const std::vector<Colour>& set, const Light& light) {
  for (const Colour mark : set) {
    const Bgr value = mark_on_plate(mark, light);
    const float own = score(mark, value);
    EXPECT_GT(own, 0.12F * value.norm()) << colour_name(mark) << " in " << light.name << " light";
    for (const Colour other : set) {
      if (other == mark) continue;
      EXPECT_LT(score(other, value), 0.7F * own)
          << colour_name(mark) << " against " << colour_name(other) << " in " << light.name;
    }
  }
}

TEST(ColourClasses, EveryColourOfALayoutScoresHighestInEveryLight) {
  for (const Light& light : kLights) {
    expect_own_scores_highest({Colour::kYellow, Colour::kBlue}, light);  // league's teams
    expect_own_scores_highest({Colour::kPink, Colour::kGreen}, light);   // league's identities
    expect_own_scores_highest({Colour::kOrange, Colour::kGreen, Colour::kWhite},
                              light);  // triangle
  }
}

// Hues that are far apart reject each other altogether. Yellow and orange, and orange and pink, are
// neighbours: no layout of ours asks to tell them apart at one place.
TEST(ColourClasses, FarHuesScoreNegative) {
  const Colour pairs[][2] = {{Colour::kYellow, Colour::kBlue}, {Colour::kPink, Colour::kGreen},
                             {Colour::kBlue, Colour::kOrange}, {Colour::kYellow, Colour::kPink},
                             {Colour::kBlue, Colour::kGreen},  {Colour::kOrange, Colour::kGreen}};
  for (const Light& light : kLights) {
    for (const auto& pair : pairs) {
      EXPECT_LT(score(pair[0], mark_on_plate(pair[1], light)), 0.0F)
          << colour_name(pair[0]) << " in " << colour_name(pair[1]) << ", " << light.name;
      EXPECT_LT(score(pair[1], mark_on_plate(pair[0], light)), 0.0F)
          << colour_name(pair[1]) << " in " << colour_name(pair[0]) << ", " << light.name;
    }
  }
}

TEST(ColourClasses, ScoreGrowsInProportionToTheLight) {
  for (int i = 0; i < kColourCount; ++i) {
    const auto colour = static_cast<Colour>(i);
    const Bgr value(120.0F, 80.0F, 200.0F);
    EXPECT_NEAR(score(colour, 0.25F * value), 0.25F * score(colour, value), 1e-4F);
    EXPECT_FLOAT_EQ(score(colour, Bgr::Zero()), 0.0F);
  }
}

TEST(ColourClasses, GreyHasNoHue) {
  for (const Colour colour :
       {Colour::kBlue, Colour::kYellow, Colour::kPink, Colour::kGreen, Colour::kOrange}) {
    EXPECT_NEAR(score(colour, Bgr::Constant(180.0F)), 0.0F, 1e-3F) << colour_name(colour);
  }
  EXPECT_NEAR(score(Colour::kWhite, Bgr::Constant(180.0F)), 180.0F, 1e-3F);
  EXPECT_NEAR(score(Colour::kBlack, Bgr::Constant(-180.0F)), 180.0F, 1e-3F);
}

// The wedge's flanks: a hue further away than the half width scores negative, a nearer one
// positive.
TEST(ColourClasses, HalfWidthIsTheAngleWhereTheScoreVanishes) {
  ColourClasses classes = default_colour_classes();
  const auto hue = [](double angle_rad) {  // (red - green, yellow - blue) = 100 (cos, sin)
    const double red_green = 100.0 * std::cos(angle_rad);
    const double yellow_blue = 100.0 * std::sin(angle_rad);
    return Bgr(static_cast<float>(100.0 - yellow_blue), static_cast<float>(100.0 - red_green / 2),
               static_cast<float>(100.0 + red_green / 2));
  };
  for (const double half_width_rad : {0.4, 0.87, 1.0}) {
    for (int i = 0; i < 12; ++i) {
      const double own_rad = i * M_PI / 6.0;
      classes.typical[static_cast<std::size_t>(Colour::kBlue)] = hue(own_rad);
      const ColourScore scored = colour_score(classes, Colour::kBlue, half_width_rad);
      for (const double side : {-1.0, 1.0}) {
        EXPECT_GT(scored(hue(own_rad + side * (half_width_rad - 0.02))), 0.0F);
        EXPECT_LT(scored(hue(own_rad + side * (half_width_rad + 0.02))), 0.0F);
      }
    }
  }
}

}  // namespace
}  // namespace nadir::vision
