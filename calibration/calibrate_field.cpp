// nadir-calibrate field: a plane map from surveyed points.

#include <iostream>
#include <memory>
#include <sstream>

#include "calibration/calibrate_commands.h"
#include "calibration/calibration_file.h"
#include "calibration/calibration_summary.h"
#include "calibration/field_points.h"
#include "calibration/fit.h"
#include "vision/input/input_error.h"

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
            if (name == "polynomial2") return "";
            return "this version of nadir fits polynomial2, not '" + name + "'";
          },
          ""};
}

void run(const FieldOptions& options) {
  if (options.output == "-" && options.json == "-") {
    throw InputError({}, "-o and --json both want stdout", "give one of them a file");
  }
  const ImageSize size =
      options.image_size.empty() ? ImageSize{} : image_size_from_text(options.image_size);
  const FieldPoints points = load_field_points(options.points);
  const FieldFit fit = fit_polynomial2(points, options.noise);
  const Calibration calibration{fit.map,           options.height_m, size.width_px, size.height_px,
                                pixel_box(points), fit.residuals,    options.noise};
  if (size.width_px > 0) {
    check_image_size(calibration, options.points, size.width_px, size.height_px);
  }
  write_text(options.output, calibration_yaml(calibration));
  if (!options.json.empty()) write_text(options.json, field_json(points, calibration, fit));
  std::cerr << field_summary(points, calibration, fit);
}

}  // namespace

void add_field_command(CLI::App& app) {
  const auto options = std::make_shared<FieldOptions>();
  CLI::App* command = app.add_subcommand("field", "fits a plane map to surveyed points");
  command->add_option("points", options->points, "POINTS.csv: u_px,v_px,x_m,y_m")->required();
  command->add_option("--model", options->model, "plane map: polynomial2")
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
                      "WxH of the images, which the tracker will then insist on");
  command->add_option("--json", options->json, "residuals and remarks as JSON; - is stdout");
  command->footer(
      "Example: nadir-calibrate field points.csv --height 0.12 --pixel-noise 0.3 -o cal.yaml");
  command->callback([options] { run(*options); });
}

}  // namespace nadir::calibration
