#include "control_client/drive/plot_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "control_client/drive/drive_errors.h"
#include "control_client/drive/drive_figure.h"
#include "vision/input/text_file.h"

namespace nadir::control_client {
void run_plot_command(const PlotOptions& options) {
  std::vector<DriveRecord> drives;
  std::vector<DriveErrors> errors;
  for (const std::string& log : options.logs) {
    drives.push_back(read_drive_log(log));
    errors.push_back(measure_drive(drives.back()));
  }
  fmt::print("{}", error_table(errors));
  if (!options.json.empty())
    vision::write_text_file(options.json, error_json(errors).dump(2) + "\n");
  if (!options.svg.empty()) vision::write_text_file(options.svg, drive_figure(drives));
}

}  // namespace nadir::control_client
