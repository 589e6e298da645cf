#include "control_client/drive/plot_command.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "control_client/drive/drive_errors.h"
#include "control_client/drive/drive_figure.h"

namespace nadir::control_client {
namespace {

void write_text(const std::string& text, const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file);
}

}  // namespace

void run_plot_command(const PlotOptions& options) {
  std::vector<DriveRecord> drives;
  std::vector<DriveErrors> errors;
  for (const std::string& log : options.logs) {
    drives.push_back(read_drive_log(log));
    errors.push_back(measure_drive(drives.back()));
  }
  fmt::print("{}", error_table(errors));
  if (!options.json.empty()) write_text(error_json(errors).dump(2) + "\n", options.json);
  if (!options.svg.empty()) write_text(drive_figure(drives), options.svg);
}

}  // namespace nadir::control_client
