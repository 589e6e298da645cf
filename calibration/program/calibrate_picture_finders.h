#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "calibration/program/calibrate_picture_points.h"

namespace nadir::calibration {

/// One picture of a folder.
struct Picture {
  std::string file;
  cv::Mat image;
};

// Each finds the points that its options of PictureOptions speak of in all pictures. Throws
// InputError where nothing is found, or something at two places.

/// TAGS.yaml:
///
///     family: tag36h11           # the default
///     tags:
///       0: [-1.0, 0.5]           # id: x, y of the tag's middle, metres
///
/// A tag in several pictures of a camera that stands still counts once, with its mean place.
std::vector<FieldPoint> tag_points(const std::vector<Picture>& pictures,
                                   const PictureOptions& options);

/// The inner corners of a checkerboard that lies on the field. Its first axis runs along its
/// columns from the origin corner; the second is a quarter turn from it to the side on which the
/// board lies. Where columns and rows are equal in number, the first axis is that from which the
/// second turns left. The same board in several pictures counts once.
std::vector<FieldPoint> checkerboard_points(const std::vector<Picture>& pictures,
                                            const PictureOptions& options);

/// The centre disc of the one robot that each picture shows. MARKERS.csv: file,x_m,y_m.
std::vector<FieldPoint> marker_points(const std::vector<Picture>& pictures,
                                      const PictureOptions& options);

/// Points with one name that should lie at one pixel: their mean, or InputError where they are
/// further apart than `limit_px`.
vision::PixelPoint mean_place(const std::vector<vision::PixelPoint>& places,
                              const std::string& name, double limit_px);

}  // namespace nadir::calibration
