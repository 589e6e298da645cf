#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "calibration/field_points.h"
#include "calibration/fit/fit.h"
#include "vision/synthetic/camera_model.h"

namespace nadir::calibration {

/// A camera 3 m high over a field of 4 x 3 m, tilted by 3 degrees. Its lens distorts by k1; the
/// image is that of the field, for with -0.3 anything wider folds.
inline vision::CameraModel experiment_camera(double k1, double k2 = 0.0, double pan_rad = 0.0) {
  vision::CameraParameters parameters;
  parameters.width_px = 960;
  parameters.height_px = 720;
  parameters.focal_px = 960.0;
  parameters.centre_u_px = 479.5;
  parameters.centre_v_px = 359.5;
  parameters.height_m = 3.0;
  parameters.tilt_rad = 3.0 * M_PI / 180.0;
  parameters.tilt_direction_rad = 0.7;
  parameters.pan_rad = pan_rad;
  parameters.k1 = k1;
  parameters.k2 = k2;
  return vision::CameraModel(parameters);
}

inline FitOptions experiment_options() { return {vision::PixelPoint(479.5, 359.5), {}}; }

/// columns x rows places of the field, with their exact images. Lines as in a file with one header
/// line.
inline FieldPoints survey(const vision::CameraModel& camera, int columns = 11, int rows = 9,
                          double height_m = 0.0) {
  FieldPoints points{"points.csv", {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d place_m(-2.0 + 4.0 * column / (columns - 1),
                                    -1.5 + 3.0 * row / (rows - 1));
      points.points.push_back({camera.project({place_m.x(), place_m.y(), height_m}), place_m,
                               static_cast<int>(points.points.size()) + 2});
    }
  }
  return points;
}

/// The middles of 40 x 30 equal cells of the field, with their exact images.
inline FieldPoints whole_field(const vision::CameraModel& camera, double height_m = 0.0) {
  FieldPoints places;
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 40; ++column) {
      const Eigen::Vector2d place_m(-1.95 + 0.1 * column, -1.45 + 0.1 * row);
      places.points.push_back({camera.project({place_m.x(), place_m.y(), height_m}), place_m, 0});
    }
  }
  return places;
}

/// Root mean square error of a map over the whole field, m.
inline double true_rms_m(const PlaneMap& map, const vision::CameraModel& camera,
                         double height_m = 0.0) {
  const FieldPoints places = whole_field(camera, height_m);
  double sum_m2 = 0.0;
  for (const FieldPoint& place : places.points) {
    sum_m2 += (place.position_m - map.plane_from_pixel(place.pixel)).squaredNorm();
  }
  return std::sqrt(sum_m2 / static_cast<double>(places.points.size()));
}

}  // namespace nadir::calibration
