#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/convex_hull.h"
#include "calibration/pixel_box.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// One surveyed point: where it stands on its plane and where the image shows it.
struct FieldPoint {
  vision::PixelPoint pixel = vision::PixelPoint::Zero();
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  int line = 0;  ///< of the points file, from 1; 0 for a point that was not read from a file
};

/// The points of one plane and the file from which they come (empty if from none), which messages
/// name.
struct FieldPoints {
  std::string file;
  std::vector<FieldPoint> points;
};

/// Reads POINTS.csv: header u_px,v_px,x_m,y_m. Throws InputError on a missing file or column, a
/// cell that is not a finite number, or no points at all.
FieldPoints load_field_points(const std::filesystem::path& file);

/// The smallest box that holds the points, of which there is at least one.
PixelBox pixel_box(const FieldPoints& points);

/// The smallest convex polygon in the image that holds the points.
ConvexHull pixel_hull(const FieldPoints& points);

}  // namespace nadir::calibration
