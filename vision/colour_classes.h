#pragma once

#include <Eigen/Core>
#include <array>

#include "vision/marker_layout.h"

namespace nadir::vision {

/// A pixel value or a difference of two, order blue, green, red, grey levels.
using Bgr = Eigen::Vector3f;

/// What the named colours look like to this camera: typical pixel values under white light. Only
/// hue and saturation matter; brightness is judged from the surroundings of each disc.
struct ColourClasses {
  std::array<Bgr, kColourCount> typical;  ///< indexed by Colour, 0 to 255

  const Bgr& of(Colour colour) const { return typical[static_cast<std::size_t>(colour)]; }
};

/// Colours that work without a calibration in daylight, dim and moderately coloured light.
ColourClasses default_colour_classes();

/// How much of a colour is in a pixel value: `along . value - |across . value| - |second . value|`,
/// grey levels; positive inside a wedge of hues about the class's own, and proportional to
/// brightness, so that hue decides and light does not. White and black are judged by brightness,
/// less whatever hue there is.
struct ColourScore {
  Bgr along = Bgr::Zero();
  Bgr across = Bgr::Zero();
  Bgr second = Bgr::Zero();

  float operator()(const Bgr& value) const {
    return along.dot(value) - std::abs(across.dot(value)) - std::abs(second.dot(value));
  }
};

/// The score of one colour class. `half_width_rad`: hues further away than this score negative.
ColourScore colour_score(const ColourClasses& classes, Colour colour, double half_width_rad);

}  // namespace nadir::vision
