#include "calibration/field_points.h"

#include <utility>

#include "vision/input/csv_table.h"

namespace nadir::calibration {

FieldPoints load_field_points(const std::filesystem::path& file) {
  const auto table = vision::CsvTable::load(file, {"u_px", "v_px", "x_m", "y_m"});
  FieldPoints result;
  result.file = file.string();
  result.points.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    result.points.push_back({{table.number(row, 0), table.number(row, 1)},
                             {table.number(row, 2), table.number(row, 3)},
                             table.line(row)});
  }
  if (result.points.empty()) {
    throw vision::InputError({result.file}, "holds no points", "write rows of u_px,v_px,x_m,y_m");
  }
  return result;
}

PixelBox pixel_box(const FieldPoints& points) {
  PixelBox box{points.points.at(0).pixel, points.points.at(0).pixel};
  for (const FieldPoint& point : points.points) {
    box.low_px = box.low_px.cwiseMin(point.pixel);
    box.high_px = box.high_px.cwiseMax(point.pixel);
  }
  return box;
}

ConvexHull pixel_hull(const FieldPoints& points) {
  std::vector<vision::PixelPoint> pixels;
  pixels.reserve(points.points.size());
  for (const FieldPoint& point : points.points) pixels.push_back(point.pixel);
  return ConvexHull::of(std::move(pixels));
}

}  // namespace nadir::calibration
