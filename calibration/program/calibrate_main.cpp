// nadir-calibrate: plane maps from surveyed points, and how good they are.

#include <iostream>

#include "calibration/program/calibrate_commands.h"
#include "vision/input/input_error.h"

namespace {

/// Parsing runs the subcommand. Returns the exit code.
int parse_and_run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::cerr << "nadir-calibrate: " << error.what() << "; see nadir-calibrate --help\n";
    return 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Maps pixels to metres from surveyed points, and says how well.", "nadir-calibrate");
  app.set_version_flag("--version", "nadir-calibrate " NADIR_VERSION);
  app.require_subcommand(1);
  app.footer("Example: nadir-calibrate field points.csv --height 0.12 -o cal.yaml");
  nadir::calibration::add_field_command(app);
  nadir::calibration::add_validate_command(app);
  nadir::calibration::add_noise_command(app);
  nadir::calibration::add_colours_command(app);
  nadir::calibration::add_compare_command(app);
  try {
    return parse_and_run(app, argc, argv);
  } catch (const nadir::vision::InputError& error) {
    std::cerr << "nadir-calibrate: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "nadir-calibrate: " << error.what() << "\n";
    return 1;
  }
}
