// nadir-calibrate: plane maps from surveyed points, and how good they are.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "calibration/calibration_file.h"
#include "calibration/calibration_summary.h"
#include "calibration/field_points.h"
#include "calibration/fit.h"
#include "calibration/validation.h"
#include "vision/input/input_error.h"

namespace {

using nadir::calibration::Calibration;
using nadir::calibration::FieldFit;
using nadir::calibration::FieldPoints;
using nadir::vision::InputError;

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

struct FieldOptions {
  std::string points;
  std::string model = "polynomial2";
  double height_m = 0.0;
  std::string output;
  nadir::calibration::StatedNoise noise;
  std::string image_size;
  std::string json;
};

struct ValidateOptions {
  std::string calibration;
  std::string points;
  std::string json;
};

/// '-' is stdout. Throws InputError where the file cannot be written.
void write_text(const std::string& file, const std::string& text) {
  if (file == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw std::runtime_error("stdout cannot be written");
    return;
  }
  std::ofstream stream(file, std::ios::binary);
  stream << text << std::flush;
  if (!stream) throw InputError({file}, "cannot be written", "check the folder and its rights");
}

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

/// CLI11's own ranges let a NaN pass.
CLI::Validator number_from_to(double low, double high) {
  return {[low, high](const std::string& text) -> std::string {
            double number = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, number);
            if (is_number && number >= low && number <= high) return "";
            std::ostringstream words;
            words << "'" << text << "' is not a number from " << low << " to " << high;
            return words.str();
          },
          ""};
}

CLI::Validator known_model() {
  return {[](const std::string& name) -> std::string {
            if (name == "polynomial2") return "";
            return "this version of nadir fits polynomial2, not '" + name + "'";
          },
          ""};
}

void describe_field(CLI::App* command, FieldOptions* options) {
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
}

void describe_validate(CLI::App* command, ValidateOptions* options) {
  command->add_option("calibration", options->calibration, "calibration file")->required();
  command->add_option("points", options->points, "POINTS.csv: u_px,v_px,x_m,y_m")->required();
  command->add_option("--json", options->json, "file for the result; without it, stdout");
  command->footer("Example: nadir-calibrate validate cal.yaml other_points.csv --json result.json");
}

void run_field(const FieldOptions& options) {
  if (options.output == "-" && options.json == "-") {
    throw InputError({}, "-o and --json both want stdout", "give one of them a file");
  }
  const ImageSize size =
      options.image_size.empty() ? ImageSize{} : image_size_from_text(options.image_size);
  const FieldPoints points = nadir::calibration::load_field_points(options.points);
  const FieldFit fit = nadir::calibration::fit_polynomial2(points, options.noise);
  const Calibration calibration{fit.map,           options.height_m, size.width_px, size.height_px,
                                pixel_box(points), fit.residuals,    options.noise};
  if (size.width_px > 0) {
    check_image_size(calibration, options.points, size.width_px, size.height_px);
  }
  write_text(options.output, calibration_yaml(calibration));
  if (!options.json.empty()) write_text(options.json, field_json(points, calibration, fit));
  std::cerr << field_summary(points, calibration, fit);
}

void run_validate(const ValidateOptions& options) {
  const Calibration calibration = nadir::calibration::load_calibration(options.calibration);
  const FieldPoints points = nadir::calibration::load_field_points(options.points);
  const auto validation = nadir::calibration::validate(calibration, points);
  write_text(options.json.empty() ? "-" : options.json, validation_json(validation));
  std::cerr << validation_summary(validation);
}

}  // namespace

int main(int argc, char** argv) {
  FieldOptions field_options;
  ValidateOptions validate_options;
  CLI::App app("Maps pixels to metres from surveyed points, and says how well.", "nadir-calibrate");
  app.set_version_flag("--version", "nadir-calibrate " NADIR_VERSION);
  app.require_subcommand(1);
  app.footer("Example: nadir-calibrate field points.csv --height 0.12 -o cal.yaml");
  CLI::App* field = app.add_subcommand("field", "fits a plane map to surveyed points");
  CLI::App* validate = app.add_subcommand("validate", "compares a calibration with points");
  describe_field(field, &field_options);
  describe_validate(validate, &validate_options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::cerr << "nadir-calibrate: " << error.what() << "; see nadir-calibrate --help\n";
    return 2;
  }
  try {
    if (field->parsed()) run_field(field_options);
    if (validate->parsed()) run_validate(validate_options);
    return 0;
  } catch (const InputError& error) {
    std::cerr << "nadir-calibrate: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "nadir-calibrate: " << error.what() << "\n";
    return 1;
  }
}
