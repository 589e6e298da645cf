// nadir-calibrate: plane maps from surveyed points, and how good they are.

#include "calibration/program/calibrate_commands.h"
#include "vision/input/run_program.h"
#include "vision/input/usage_line.h"

int main(int argc, char** argv) {
  CLI::App app("Maps pixels to metres from surveyed points, and says how well.", "nadir-calibrate");
  app.set_version_flag("--version", "nadir-calibrate " NADIR_VERSION);
  app.failure_message(nadir::vision::usage_line);
  app.require_subcommand(1);
  app.footer("Example: nadir-calibrate field points.csv --height 0.12 -o cal.yaml");
  nadir::calibration::add_field_command(app);
  nadir::calibration::add_validate_command(app);
  nadir::calibration::add_noise_command(app);
  nadir::calibration::add_colours_command(app);
  nadir::calibration::add_compare_command(app);
  return nadir::vision::run_program(app, argc, argv, [] {});
}
