#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "calibration/field_points.h"

namespace nadir::calibration {

/// What lies on the field in a folder of pictures. One kind at a time.
struct PictureOptions {
  std::string tags;          ///< TAGS.yaml: places of AprilTags
  std::string checkerboard;  ///< "8x6": inner corners of a board
  double square_m = 0.0;
  std::string origin;  ///< "x,y,deg": place of the board's first corner, direction of its columns
  std::string origin_corner;  ///< which corner of the picture's board that is: "top-left", ...
  std::string markers;        ///< MARKERS.csv: file,x_m,y_m of a robot in each picture
  std::string layout;         ///< of that robot
  std::string save_points;    ///< POINTS.csv to write
};

/// Points found in pictures, and the pictures' size.
struct SurveyedPictures {
  FieldPoints points;
  int width_px = 0;
  int height_px = 0;
};

void add_picture_options(CLI::App& command, PictureOptions& options);

/// Whether `path` is a folder of pictures and not POINTS.csv. Throws InputError where the options
/// do not go with it.
bool is_picture_folder(const std::string& path, const PictureOptions& options);

/// Looks in all pictures of a folder for what the options say. Points have the line that they have
/// in the file of --save-points. Throws InputError: no pictures, nothing found, what is found twice
/// in different places.
SurveyedPictures points_from_pictures(const std::string& folder, const PictureOptions& options);

}  // namespace nadir::calibration
