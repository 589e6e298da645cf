#include "vision/synthetic/scene.h"

#include <algorithm>

namespace nadir::vision {

std::array<Reflectance, kColourCount> printed_reflectances() {
  std::array<Reflectance, kColourCount> printed;
  const auto set = [&printed](Colour colour, float blue, float green, float red) {
    printed[static_cast<std::size_t>(colour)] = {blue, green, red};
  };
  set(Colour::kBlue, 0.96F, 0.58F, 0.08F);
  set(Colour::kYellow, 0.15F, 0.86F, 1.00F);
  set(Colour::kPink, 0.67F, 0.25F, 1.00F);
  set(Colour::kGreen, 0.42F, 0.94F, 0.54F);
  set(Colour::kOrange, 0.10F, 0.52F, 0.98F);
  set(Colour::kWhite, 1.00F, 1.00F, 1.00F);
  set(Colour::kBlack, 0.05F, 0.05F, 0.05F);
  return printed;
}

RobotBody default_body(const MarkerLayout& layout) {
  RobotBody body;
  body.radius_m = layout.extent_m() + 0.005;
  body.front_m = body.radius_m;
  if (layout.tags) return body;
  double foremost_m = layout.centre_radius_m;
  for (const Disc& disc : layout.outer) {
    foremost_m = std::max(foremost_m, disc.position_robot_m.x() + disc.radius_m);
  }
  body.front_m = foremost_m + 0.010;
  return body;
}

}  // namespace nadir::vision
