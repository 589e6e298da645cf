#include "vision/colour_classes.h"

namespace nadir::vision {

ColourClasses default_colour_classes() {
  ColourClasses classes;
  const auto set = [&classes](Colour colour, float blue, float green, float red) {
    classes.typical[static_cast<std::size_t>(colour)] = {blue, green, red};
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

}  // namespace nadir::vision
