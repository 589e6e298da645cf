// Surveyed points out of pictures.

#include "calibration/program/calibrate_picture_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "calibration/program/calibrate_commands.h"
#include "calibration/program/calibrate_picture_finders.h"
#include "calibration/program/calibrate_pictures.h"
#include "vision/input/input_error.h"
#include "vision/input/text_file.h"

namespace nadir::calibration {
namespace {

using vision::InputError;

bool is_picture(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::vector<std::string> endings = {".png", ".jpg", ".jpeg", ".bmp",
                                                   ".ppm", ".tif", ".tiff"};
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

std::vector<Picture> load_pictures(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (is_picture(entry.path())) files.push_back(entry.path());
  }
  if (files.empty()) {
    throw InputError({folder}, "holds no picture", "give a folder of PNG or JPEG pictures");
  }
  std::sort(files.begin(), files.end());
  std::vector<Picture> pictures;
  for (const auto& file : files) {
    pictures.push_back({file.string(), load_picture(file.string())});
    if (pictures.back().image.size() == pictures.front().image.size()) continue;
    throw InputError({file.string()}, "has another size than " + pictures.front().file,
                     "give pictures of one camera at a time");
  }
  return pictures;
}

std::string points_csv(const FieldPoints& points) {
  std::string text = "u_px,v_px,x_m,y_m\n";
  for (const FieldPoint& point : points.points) {
    text += fmt::format("{:.4f},{:.4f},{},{}\n", point.pixel.x(), point.pixel.y(),
                        point.position_m.x(), point.position_m.y());
  }
  return text;
}

std::vector<FieldPoint> find_points(const std::vector<Picture>& pictures,
                                    const PictureOptions& options) {
  if (!options.tags.empty()) return tag_points(pictures, options);
  if (!options.checkerboard.empty()) return checkerboard_points(pictures, options);
  return marker_points(pictures, options);
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
  auto* tags = command.add_option("--tags", options.tags,
                                  "TAGS.yaml: places of the AprilTags in a folder of pictures");
  auto* board = command.add_option("--checkerboard", options.checkerboard,
                                   "inner corners of a board on the field, like 8x6");
  auto* square =
      command.add_option("--square", options.square_m, "side of a square of the board, m")
          ->check(number_from_to(1e-4, 100.0));
  auto* origin = command.add_option(
      "--origin", options.origin,
      "X,Y,DEG: place of the board's first corner, direction of its columns on the field");
  auto* corner =
      command
          .add_option("--origin-corner", options.origin_corner,
                      "which corner of the board that is in the picture")
          ->check(CLI::IsMember({"top-left", "top-right", "bottom-left", "bottom-right"}));
  auto* markers = command.add_option(
      "--markers", options.markers,
      "MARKERS.csv: file,x_m,y_m of the robot that each picture of a folder shows");
  auto* layout = command.add_option("--layout", options.layout, "layout of that robot");
  command.add_option("--save-points", options.save_points,
                     "POINTS.csv to write, with what was found in the pictures");
  board->needs(square)->needs(origin)->needs(corner);
  square->needs(board);
  origin->needs(board);
  corner->needs(board);
  markers->needs(layout);
  layout->needs(markers);
  tags->excludes(board)->excludes(markers);
  board->excludes(markers);
}

bool is_picture_folder(const std::string& path, const PictureOptions& options) {
  const bool speaks_of_pictures =
      !options.tags.empty() || !options.checkerboard.empty() || !options.markers.empty();
  const bool is_folder = std::filesystem::is_directory(path);
  if (speaks_of_pictures && !is_folder) {
    throw InputError({path}, "is no folder of pictures",
                     "leave out --tags, --checkerboard and --markers, or give a folder");
  }
  if (is_folder && !speaks_of_pictures) {
    throw InputError({path}, "is a folder, but what lies in its pictures is not said",
                     "add --tags, --checkerboard or --markers");
  }
  if (!is_folder && !options.save_points.empty()) {
    throw InputError({path}, "is no folder of pictures", "leave out --save-points");
  }
  return is_folder;
}

SurveyedPictures points_from_pictures(const std::string& folder, const PictureOptions& options) {
  const std::vector<Picture> pictures = load_pictures(folder);
  SurveyedPictures found;
  found.width_px = pictures.front().image.cols;
  found.height_px = pictures.front().image.rows;
  found.points.file = options.save_points.empty() ? folder : options.save_points;
  found.points.points = find_points(pictures, options);
  int line = 2;  // behind the header
  for (FieldPoint& point : found.points.points) point.line = line++;
  if (!options.save_points.empty())
    vision::write_text_file(options.save_points, points_csv(found.points));
  return found;
}

}  // namespace nadir::calibration
