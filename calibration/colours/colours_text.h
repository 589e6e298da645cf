#pragma once

#include <string>

#include "calibration/colours/colours_statistics.h"
#include "vision/colour_classes.h"

namespace nadir::calibration {

/// How many robots the frames show, with the colours that come out and with the default ones.
struct RobotCounts {
  int images = 0;
  int robots = 0;
  int robots_by_default = 0;
};

/// COLOURS.yaml, as vision's load_colour_classes reads it.
std::string colours_yaml(const ColourStudy& study, const vision::ColourClasses& classes,
                         const std::string& origin);
/// Statistics of each class, margins, what is nearest to confusion. Lines, with an end of line
/// each.
std::string colours_summary(const ColourStudy& study, const RobotCounts& counts);
/// The same for a program: one JSON object.
std::string colours_json(const ColourStudy& study, const vision::ColourClasses& classes,
                         const RobotCounts& counts);

}  // namespace nadir::calibration
