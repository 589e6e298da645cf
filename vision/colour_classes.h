#pragma once

#include <array>

#include "vision/marker_layout.h"

namespace nadir::vision {

/// What the named colours look like to this camera: typical pixel values under white light. Only their hue and
/// saturation matter; brightness is judged from the surroundings of each disc.
struct ColourClasses {
  struct Bgr {
    float blue = 0.0F;
    float green = 0.0F;
    float red = 0.0F;
  };
  std::array<Bgr, kColourCount> typical;  ///< indexed by Colour, 0 to 255

  const Bgr& of(Colour colour) const { return typical[static_cast<std::size_t>(colour)]; }
};

/// Colours that work without a calibration in daylight, dim and moderately coloured light.
ColourClasses default_colour_classes();

}  // namespace nadir::vision
