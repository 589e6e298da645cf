// nadir-calibrate field: a plane map from surveyed points.

#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "calibration/calibration_file.h"
#include "calibration/field_calibration.h"
#include "calibration/program/calibrate_commands.h"
#include "calibration/program/calibrate_picture_points.h"
#include "calibration/program/calibration_summary.h"
#include "calibration/report/report_html.h"
#include "calibration/report/report_json.h"
#include "calibration/report/report_numbers.h"
#include "calibration/survey_file.h"
#include "vision/input/input_error.h"
#include "vision/input/text_file.h"

namespace nadir::calibration {
namespace {

using vision::InputError;

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

struct FieldOptions {
  std::string points;
  std::string model = "polynomial2";
  double height_m = 0.0;
  std::string output;
  StatedNoise noise;
  std::string image_size;
  std::optional<double> camera_height_m;
  std::string nadir;
  std::optional<double> focal_px;
  bool force = false;
  PictureOptions pictures;
  std::string report;
  std::string json;
};

/// "1280x1024".
ImageSize image_size_from_text(const std::string& text) {
  std::istringstream stream(text);
  ImageSize size;
  char separator = 0;
  stream >> size.width_px >> separator >> size.height_px;
  const bool is_read = stream && stream.peek() == std::istringstream::traits_type::eof();
  if (!is_read || separator != 'x' || size.width_px < 1 || size.height_px < 1) {
    throw InputError({}, "--image-size is '" + text + "'", "write it like 1280x1024");
  }
  return size;
}

CLI::Validator known_model() {
  return {[](const std::string& name) -> std::string {
            if (name == "auto" || model_from_name(name)) return "";
            return "'" + name +
                   "' is none of polynomial2, polynomial3, polynomial4, polynomial5, " +
                   "homography, radial, radial2, auto";
          },
          ""};
}

/// "1.5,-0.25".
Eigen::Vector2d place_from_text(const std::string& text) {
  std::istringstream stream(text);
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  char separator = 0;
  stream >> place_m.x() >> separator >> place_m.y();
  const bool is_read = stream && stream.peek() == std::istringstream::traits_type::eof();
  if (!is_read || separator != ',' || !place_m.allFinite()) {
    throw InputError({}, "--nadir is '" + text + "'", "write it like 1.5,-0.25");
  }
  return place_m;
}

FieldSettings settings_of(const FieldOptions& options) {
  FieldSettings settings;
  settings.model = model_from_name(options.model);  // nothing for auto
  settings.height_m = options.height_m;
  settings.noise = options.noise;
  if (!options.image_size.empty()) {
    const ImageSize size = image_size_from_text(options.image_size);
    settings.image_width_px = size.width_px;
    settings.image_height_px = size.height_px;
  }
  if (options.camera_height_m.has_value() == options.nadir.empty()) {
    throw InputError({}, "--camera-height and --nadir belong together", "give both or none");
  }
  settings.camera.height_m = options.camera_height_m;
  if (!options.nadir.empty()) settings.camera.nadir_m = place_from_text(options.nadir);
  settings.camera.focal_px = options.focal_px;
  if (options.camera_height_m && *options.camera_height_m <= options.height_m) {
    throw InputError({}, "--camera-height is not above --height",
                     "give both in metres above the field");
  }
  return settings;
}

/// From the CSV file, or out of pictures, whose size then is the images' size.
Survey survey_of(const FieldOptions& options, FieldSettings& settings) {
  if (!is_picture_folder(options.points, options.pictures)) {
    return load_survey(options.points, options.height_m);
  }
  SurveyedPictures pictures = points_from_pictures(options.points, options.pictures);
  settings.image_width_px = pictures.width_px;
  settings.image_height_px = pictures.height_px;
  return {std::move(pictures.points), {}};
}

/// Report and JSON.
void write_figures(const FieldOptions& options, const FieldPoints& points,
                   const FieldResult& result) {
  if (options.report.empty() && options.json.empty()) return;
  const ReportNumbers numbers = report_numbers(points, result);
  if (!options.report.empty())
    vision::write_text_file(options.report, report_html(points, result, numbers));
  if (!options.json.empty()) {
    vision::write_text_file(options.json, with_report_numbers(field_json(points, result), numbers));
  }
}

void run(const FieldOptions& options) {
  if (options.output == "-" && options.json == "-") {
    throw InputError({}, "-o and --json both want stdout", "give one of them a file");
  }
  FieldSettings settings = settings_of(options);
  Survey survey = survey_of(options, settings);
  settings.camera.other_heights = std::move(survey.others);
  const FieldPoints& points = survey.plane;
  const FieldResult result = calibrate_field(points, settings);
  if (settings.image_width_px > 0) {
    check_image_size(result.calibration, options.points, settings.image_width_px,
                     settings.image_height_px);
  }
  // Wrong points make no calibration; what was asked for besides shows what is wrong with them.
  const bool is_refused = result.assessment.grade == Grade::kFail && !options.force;
  if (!is_refused) vision::write_text_file(options.output, calibration_yaml(result.calibration));
  write_figures(options, points, result);
  std::cerr << field_summary(points, result);
  if (is_refused) {
    throw std::runtime_error(options.output +
                             " is not written; correct the points, or insist with --force");
  }
}

}  // namespace

void add_field_command(CLI::App& app) {
  const auto options = std::make_shared<FieldOptions>();
  CLI::App* command = app.add_subcommand("field", "fits a plane map to surveyed points");
  command
      ->add_option("points", options->points,
                   "POINTS.csv: u_px,v_px,x_m,y_m, or a folder of pictures; a column z_m holds the "
                   "height above the field, "
                   "and points at a second height tell where the camera is")
      ->required();
  command
      ->add_option("--model", options->model,
                   "plane map: polynomial2 to polynomial5, homography, radial, radial2, auto")
      ->check(known_model())
      ->capture_default_str();
  command->add_option("--height", options->height_m, "of the points' plane above the field, m")
      ->required()
      ->check(number_from_to(0.0, 100.0));
  command->add_option("-o,--output", options->output, "calibration file to write; - is stdout")
      ->required();
  command
      ->add_option("--pixel-noise", options->noise.pixel_px,
                   "error of finding a point in the image, one sigma per axis, px")
      ->check(number_from_to(0.0, 1000.0));
  command
      ->add_option("--survey-noise", options->noise.survey_m,
                   "error of measuring a point on the field, one sigma per axis, m")
      ->check(number_from_to(0.0, 10.0));
  command->add_option("--image-size", options->image_size,
                      "WxH of the images, which the tracker will then insist on; their middle is "
                      "where a lens is taken to be centred");
  command
      ->add_option("--camera-height", options->camera_height_m,
                   "of the camera above the field, m; with --nadir, markers at other heights are "
                   "corrected for parallax")
      ->check(number_from_to(0.0, 1000.0));
  command->add_option("--nadir", options->nadir, "X,Y of the field below the camera, m");
  command
      ->add_option("--focal-px", options->focal_px,
                   "focal length, px: tells the camera's place from the map itself")
      ->check(number_from_to(1.0, 1e6));
  command->add_flag("--force", options->force, "write the calibration although its grade is FAIL");
  add_picture_options(*command, options->pictures);
  command->add_option("--report", options->report,
                      "HTML page with figures: residuals, own error, coverage, models");
  command->add_option("--json", options->json,
                      "residuals, findings and the report's numbers as JSON; - is stdout");
  command->footer(
      "Example: nadir-calibrate field points.csv --height 0.12 --pixel-noise 0.3 -o cal.yaml");
  command->callback([options] { run(*options); });
}

}  // namespace nadir::calibration
