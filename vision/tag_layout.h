#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vision/tag_family.h"

namespace nadir::vision {

/// Where a tag lies on its robot: the tag's middle in the robot's frame (x to the front, y to the
/// left), and the direction of the tag's x axis there, which is the right hand of the upright
/// print.
struct TagMount {
  Eigen::Vector2d position_robot_m = Eigen::Vector2d::Zero();
  double heading_robot_rad = 0.0;
};

/// A tag that some robot of a layout carries.
struct MountedTag {
  int tag_id = 0;
  int robot_id = 0;
  TagMount mount;
};

/// How robots with tags look from above.
struct TagLayout {
  int family = 0;       ///< index into kTagFamilies
  double size_m = 0.0;  ///< side of the square whose corners are detected
  /// By rising tag_id. Empty: every tag of the family is the robot of its own number.
  std::vector<MountedTag> tags;
  TagMount usual_mount;  ///< of every tag if `tags` is empty

  const TagFamily& facts() const { return kTagFamilies[static_cast<std::size_t>(family)]; }
  /// The tag with this number, or nothing if no robot carries it.
  std::optional<MountedTag> find(int tag_id) const;
  /// All tags of one robot.
  std::vector<MountedTag> tags_of(int robot_id) const;
  /// Side of the printed mark with its margin.
  double printed_size_m() const { return size_m * facts().cells / facts().square_cells; }
};

}  // namespace nadir::vision
