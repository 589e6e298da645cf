#include "vision/colour_classes.h"

#include <cmath>

namespace nadir::vision {
namespace {

// Two opponent axes that both vanish for grey: red against green, and yellow against blue.
const Bgr kRedGreen(0.0F, -1.0F, 1.0F);
const Bgr kYellowBlue(-1.0F, 0.5F, 0.5F);

}  // namespace

ColourClasses default_colour_classes() {
  ColourClasses classes;
  const auto set = [&classes](Colour colour, float blue, float green, float red) {
    classes.typical[static_cast<std::size_t>(colour)] = Bgr(blue, green, red);
  };
  set(Colour::kBlue, 220, 110, 30);
  set(Colour::kYellow, 30, 210, 240);
  set(Colour::kPink, 160, 60, 240);
  set(Colour::kGreen, 110, 220, 90);
  set(Colour::kOrange, 40, 130, 250);
  set(Colour::kWhite, 240, 240, 240);
  set(Colour::kBlack, 30, 30, 30);
  return classes;
}

ColourScore colour_score(const ColourClasses& classes, Colour colour, double half_width_rad) {
  ColourScore score;
  if (colour == Colour::kWhite || colour == Colour::kBlack) {
    score.along = Bgr::Constant(colour == Colour::kWhite ? 1.0F / 3.0F : -1.0F / 3.0F);
    score.across = kRedGreen;
    score.second = kYellowBlue;
    return score;
  }
  const Bgr& typical = classes.of(colour);
  const float hue_rad = std::atan2(kYellowBlue.dot(typical), kRedGreen.dot(typical));
  const float steepness = 1.0F / static_cast<float>(std::tan(half_width_rad));
  score.along = std::cos(hue_rad) * kRedGreen + std::sin(hue_rad) * kYellowBlue;
  score.across = steepness * (-std::sin(hue_rad) * kRedGreen + std::cos(hue_rad) * kYellowBlue);
  return score;
}

}  // namespace nadir::vision
