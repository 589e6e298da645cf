#pragma once

#include <filesystem>

#include "vision/colour_classes.h"

namespace nadir::vision {

/// Reads how named colours look to a camera, blue green red from 0 to 255:
///
///     colours:
///       blue: [210, 120, 40]
///       pink: [150, 70, 230]
///
/// Colours that are not named keep their default. Throws InputError: a colour that layouts cannot
/// name, a value that is out of range, an unknown or duplicate key.
ColourClasses load_colour_classes(const std::filesystem::path& file);

}  // namespace nadir::vision
