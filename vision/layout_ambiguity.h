#pragma once

#include <optional>
#include <string>

#include "vision/marker_layout.h"

namespace nadir::vision {

/// Looks for two robots of the layout, or one robot in two poses, that show the same picture: their
/// discs can be turned and shifted onto each other with the same colours. Such a layout gives no
/// heading or no identity. Discs count as the same place within a quarter of the smaller radius,
/// which is what a far camera can tell.
/// @return a description of the first such pair, or nothing if every robot is unmistakable
std::optional<std::string> find_ambiguity(const MarkerLayout& layout);

}  // namespace nadir::vision
