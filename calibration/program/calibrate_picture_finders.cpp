#include "calibration/program/calibrate_picture_finders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>

#include "calibration/program/calibrate_colours_search.h"
#include "calibration/program/picture_checkerboard.h"
#include "vision/input/csv_table.h"
#include "vision/input/input_error.h"
#include "vision/input/strict_yaml.h"
#include "vision/tag_detector.h"

namespace nadir::calibration {
namespace {

using vision::InputError;
using vision::PixelPoint;

/// A thing that lies still is seen at the same pixel; further apart, and it or the camera moved.
constexpr double kStill_px = 1.0;

struct SurveyedTags {
  std::string family;
  std::map<int, Eigen::Vector2d> places_m;
};

SurveyedTags load_tags(const std::string& path) {
  constexpr vision::ValidRange kPlace_m{-1e4, 1e4};
  const auto file = vision::YamlMap::load(path);
  SurveyedTags tags;
  tags.family = file.choice_or("family", "tag36h11", vision::tag_families());
  const auto map = file.map("tags");
  for (const std::string& key : map.keys()) {
    const int id = map.integer_key(key, {0, 1e6});
    const std::vector<double> place = map.numbers(key, 2, kPlace_m);
    tags.places_m[id] = {place[0], place[1]};
  }
  if (tags.places_m.empty()) {
    throw file.error("tags", "'tags' is empty", "write lines like 0: [-1.0, 0.5]");
  }
  map.finish();
  file.finish();
  return tags;
}

BoardSize board_size(const std::string& text) {
  BoardSize size;
  char separator = 0;
  std::istringstream stream(text);
  stream >> size.columns >> separator >> size.rows;
  const bool is_read = stream && stream.peek() == std::istringstream::traits_type::eof();
  const bool in_range =
      size.columns >= 3 && size.columns <= 100 && size.rows >= 3 && size.rows <= 100;
  if (is_read && separator == 'x' && in_range) return size;
  throw InputError({}, "--checkerboard is '" + text + "'",
                   "write the numbers of its inner corners like 8x6, each from 3 to 100");
}

/// Where the board lies on the field.
struct BoardOrigin {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  double direction_rad = 0.0;
};

BoardOrigin board_origin(const std::string& text) {
  std::array<double, 3> numbers{};
  std::array<char, 2> commas{};
  std::istringstream stream(text);
  stream >> numbers[0] >> commas[0] >> numbers[1] >> commas[1] >> numbers[2];
  const bool is_read = stream && stream.peek() == std::istringstream::traits_type::eof();
  if (is_read && commas[0] == ',' && commas[1] == ',') {
    return {{numbers[0], numbers[1]}, numbers[2] * std::numbers::pi / 180.0};
  }
  throw InputError({}, "--origin is '" + text + "'", "write x and y in metres and degrees: 0,0,90");
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The board with its corner (0, 0) where the picture has it, and columns along its first axis.
BoardCorners turned(const BoardCorners& board, const std::string& origin_corner) {
  // The outermost corner in a diagonal direction of the picture.
  const Eigen::Vector2d direction(origin_corner.ends_with("left") ? -1.0 : 1.0,
                                  origin_corner.starts_with("top") ? -1.0 : 1.0);
  const int last_column = board.size.columns - 1;
  const int last_row = board.size.rows - 1;
  bool flip_columns = false;
  bool flip_rows = false;
  double farthest = -1e18;
  for (const bool columns : {false, true}) {
    for (const bool rows : {false, true}) {
      const double reach = direction.dot(board.at(columns ? last_column : 0, rows ? last_row : 0));
      if (reach <= farthest) continue;
      farthest = reach;
      flip_columns = columns;
      flip_rows = rows;
    }
  }
  BoardCorners result{board.size, {}};
  for (int row = 0; row < board.size.rows; ++row) {
    for (int column = 0; column < board.size.columns; ++column) {
      result.corners.push_back(
          board.at(flip_columns ? last_column - column : column, flip_rows ? last_row - row : row));
    }
  }
  if (board.size.columns != board.size.rows) return result;
  // Either side may be the first axis: the one from which the other turns left (v points down).
  const Eigen::Vector2d along = result.at(last_column, 0) - result.at(0, 0);
  const Eigen::Vector2d across = result.at(0, last_row) - result.at(0, 0);
  if (cross(along, across) < 0.0) return result;
  BoardCorners swapped{board.size, {}};
  for (int row = 0; row < board.size.rows; ++row) {
    for (int column = 0; column < board.size.columns; ++column) {
      swapped.corners.push_back(result.at(row, column));
    }
  }
  return swapped;
}

}  // namespace

PixelPoint mean_place(const std::vector<PixelPoint>& places, const std::string& name,
                      double limit_px) {
  PixelPoint mean = PixelPoint::Zero();
  for (const PixelPoint& place : places) mean += place / static_cast<double>(places.size());
  for (const PixelPoint& place : places) {
    if ((place - mean).norm() <= limit_px) continue;
    throw InputError({},
                     fmt::format("{} is at u {:.1f}, v {:.1f} px in one picture and {:.1f} px from "
                                 "its mean place in another",
                                 name, mean.x(), mean.y(), (place - mean).norm()),
                     "neither it nor the camera may move between the pictures, and none may be "
                     "there twice");
  }
  return mean;
}

std::vector<FieldPoint> tag_points(const std::vector<Picture>& pictures,
                                   const PictureOptions& options) {
  const SurveyedTags surveyed = load_tags(options.tags);
  vision::TagDetector detector(surveyed.family);
  std::map<int, std::vector<PixelPoint>> seen;
  for (const Picture& picture : pictures) {
    for (const vision::TagObservation& tag : detector.detect(picture.image)) {
      if (surveyed.places_m.contains(tag.id)) seen[tag.id].push_back(tag.centre_px);
    }
  }
  if (seen.empty()) {
    throw InputError({pictures.front().file},
                     fmt::format("and {} other pictures show none of the {} tags of {}",
                                 pictures.size() - 1, surveyed.places_m.size(), options.tags),
                     "check family and ids; tags must be 14 px wide or more");
  }
  std::vector<FieldPoint> points;
  points.reserve(seen.size());
  for (const auto& [id, places] : seen) {
    points.push_back(
        {mean_place(places, fmt::format("tag {}", id), kStill_px), surveyed.places_m.at(id), 0});
  }
  return points;
}

std::vector<FieldPoint> checkerboard_points(const std::vector<Picture>& pictures,
                                            const PictureOptions& options) {
  const BoardSize size = board_size(options.checkerboard);
  const BoardOrigin origin = board_origin(options.origin);
  std::vector<BoardCorners> boards;
  for (const Picture& picture : pictures) {
    if (const auto found = find_checkerboard(picture.image, size)) {
      boards.push_back(turned(*found, options.origin_corner));
    }
  }
  if (boards.empty()) {
    throw InputError({pictures.front().file},
                     fmt::format("and {} other pictures show no board of {}x{} inner corners",
                                 pictures.size() - 1, size.columns, size.rows),
                     "the whole board must be seen, its squares 8 px wide or more");
  }
  const BoardCorners& first = boards.front();
  const Eigen::Vector2d along = first.at(size.columns - 1, 0) - first.at(0, 0);
  const Eigen::Vector2d across = first.at(0, size.rows - 1) - first.at(0, 0);
  // v points down: what turns right in numbers turns left for the eye, and on the field.
  const double left = cross(along, across) < 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d columns_m(std::cos(origin.direction_rad), std::sin(origin.direction_rad));
  const Eigen::Vector2d rows_m = left * Eigen::Vector2d(-columns_m.y(), columns_m.x());
  std::vector<FieldPoint> points;
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      std::vector<PixelPoint> places;
      places.reserve(boards.size());
      for (const BoardCorners& board : boards) places.push_back(board.at(column, row));
      points.push_back({mean_place(places, "the board", kStill_px),
                        origin.place_m + options.square_m * (column * columns_m + row * rows_m),
                        0});
    }
  }
  return points;
}

std::vector<FieldPoint> marker_points(const std::vector<Picture>& pictures,
                                      const PictureOptions& options) {
  const vision::MarkerLayout layout = vision::load_disc_layout(options.layout);
  const auto table = vision::CsvTable::load(options.markers, {"file", "x_m", "y_m"});
  std::vector<cv::Mat> images;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto picture = std::find_if(pictures.begin(), pictures.end(), [&](const Picture& each) {
      return std::filesystem::path(each.file).filename() == table.text(row, 0);
    });
    if (picture == pictures.end()) {
      throw table.error(row, 0, "there is no picture '" + table.text(row, 0) + "' in the folder",
                        "write names of pictures, without their folder");
    }
    images.push_back(picture->image);
    rows.push_back(row);
  }
  if (images.empty()) {
    throw InputError({options.markers}, "holds no rows", "write rows of file,x_m,y_m");
  }
  const ColourSearchResult found = search_colours(images, layout, std::nullopt, options.markers);
  std::vector<FieldPoint> points;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto& robots = found.frames[i].robots;
    if (robots.size() != 1) {
      throw table.error(rows[i], 0,
                        fmt::format("'{}' shows {} robots of layout '{}'", table.text(rows[i], 0),
                                    robots.size(), layout.name),
                        "each picture must show one, in good light");
    }
    points.push_back({robots.front().discs[0].centre_px,
                      {table.number(rows[i], 1), table.number(rows[i], 2)},
                      0});
  }
  return points;
}

}  // namespace nadir::calibration
