// nadir-calibrate validate: a calibration judged by points that it need not have seen.

#include <iostream>
#include <memory>

#include "calibration/calibration_file.h"
#include "calibration/field_points.h"
#include "calibration/program/calibrate_commands.h"
#include "calibration/program/calibrate_picture_points.h"
#include "calibration/program/calibration_summary.h"
#include "calibration/validation.h"
#include "vision/input/text_file.h"

namespace nadir::calibration {
namespace {

struct ValidateOptions {
  std::string calibration;
  std::string points;
  PictureOptions pictures;
  std::string json;
};

void run(const ValidateOptions& options) {
  const Calibration calibration = load_calibration(options.calibration);
  const FieldPoints points = is_picture_folder(options.points, options.pictures)
                                 ? points_from_pictures(options.points, options.pictures).points
                                 : load_field_points(options.points);
  const Validation validation = validate(calibration, points);
  vision::write_text_file(options.json.empty() ? "-" : options.json, validation_json(validation));
  std::cerr << validation_summary(validation);
}

}  // namespace

void add_validate_command(CLI::App& app) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* command = app.add_subcommand("validate", "compares a calibration with points");
  command->add_option("calibration", options->calibration, "calibration file")->required();
  command
      ->add_option("points", options->points,
                   "POINTS.csv: u_px,v_px,x_m,y_m, or a folder of pictures")
      ->required();
  add_picture_options(*command, options->pictures);
  command->add_option("--json", options->json, "file for the result; without it, stdout");
  command->footer("Example: nadir-calibrate validate cal.yaml other_points.csv --json result.json");
  command->callback([options] { run(*options); });
}

}  // namespace nadir::calibration
