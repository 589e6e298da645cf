#pragma once

#include <array>
#include <optional>
#include <vector>

#include "vision/colour_classes.h"
#include "vision/marker_layout.h"

namespace nadir::calibration {

/// One disc of a robot that was found: its colour is known from the layout, what the camera made of
/// it was measured.
struct ColourSample {
  vision::Colour colour = vision::Colour::kBlack;
  vision::Bgr value = vision::Bgr::Zero();         ///< of the disc's middle, grey levels
  vision::Bgr surroundings = vision::Bgr::Zero();  ///< of what is around it
};

/// How one named colour looks to the camera.
struct ColourStatistics {
  int samples = 0;
  vision::Bgr value = vision::Bgr::Zero();       ///< mean of the discs' middles
  vision::Bgr difference = vision::Bgr::Zero();  ///< mean difference from the surroundings
  double hue_rad = 0.0;        ///< of the difference, in the plane of colour_score: 0 red, pi green
  double hue_sigma_rad = 0.0;  ///< scatter of the samples about it
  double chroma = 0.0;         ///< length of the difference in that plane, grey levels
};

/// Two colours and how far apart they are.
struct ColourMargin {
  vision::Colour a = vision::Colour::kBlack;
  vision::Colour b = vision::Colour::kBlack;
  double hue_rad = 0.0;  ///< angle between their hues
  double sigmas = 0.0;   ///< half of it over the larger scatter: how rare a confusion is
};

struct ColourStudy {
  std::array<ColourStatistics, vision::kColourCount> colours;  ///< indexed by Colour
  /// Pairs of hues that were both seen, the nearest first.
  std::vector<ColourMargin> margins;

  const ColourStatistics& of(vision::Colour colour) const {
    return colours[static_cast<std::size_t>(colour)];
  }
};

/// Angle and length of a difference of two pixel values in the plane of the two opponent axes that
/// vanish for grey (red - green, yellow - blue; vision/colour_classes).
struct Hue {
  double angle_rad = 0.0;
  double chroma = 0.0;
};
Hue hue_of(const vision::Bgr& difference);

/// White and black have no hue and stand in no margin.
bool has_hue(vision::Colour colour);

ColourStudy study_colours(const std::vector<ColourSample>& samples);

/// The colours as the detector should expect them: of those seen, their mean difference from the
/// surroundings, raised to positive values by grey, which does not change its hue. Of those not
/// seen, the default in the light that the others tell of. Values are whole numbers from 0 to 255.
vision::ColourClasses classes_from(const ColourStudy& study);

/// Default colours under a light with these gains of blue, green and red, as far as the range of
/// pixel values allows; brightness is kept.
vision::ColourClasses lit_default_classes(const vision::Bgr& gains);

/// Gains of blue, green and red, of geometric mean 1, with which the default colours come nearest
/// to those seen; 1 where no hue was seen.
vision::Bgr light_gains(const ColourStudy& study);

}  // namespace nadir::calibration
