#pragma once

#include "vision/input/strict_yaml.h"
#include "vision/tag_layout.h"

namespace nadir::vision {

/// The keys that only layouts of kind apriltag have:
///
///     family: tag36h11          # or 36h11; tag25h9, tag16h5, tagStandard41h12
///     tag_size_m: 0.10          # side of the square between the detected corners
///     offset: {x_m: 0, y_m: 0, heading_rad: 0}           # of the tags on their robots; optional
///     robots: {7: 1, 8: 1, 9: 2}                          # tag: robot; without it, its own number
///     offsets: {8: {x_m: -0.1, y_m: 0, heading_rad: 0}}   # of single tags of `robots`
///
/// Throws InputError: unknown family, a number that the family does not have, two tags of one robot
/// that overlap.
TagLayout read_tag_layout(const YamlMap& file);

}  // namespace nadir::vision
