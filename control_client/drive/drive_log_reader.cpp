#include "control_client/drive/drive_log_reader.h"

#include "vision/input/csv_table.h"

namespace nadir::control_client {

DriveRecord read_drive_log(const std::filesystem::path& file) {
  const std::vector<std::string> columns = {"mode",        "phase",       "t_s",
                                            "command_x_m", "command_y_m", "command_heading_rad",
                                            "nominal_x_m", "nominal_y_m", "nominal_heading_rad",
                                            "x_m",         "y_m",         "heading_rad",
                                            "encoder_x_m", "encoder_y_m", "encoder_heading_rad",
                                            "true_x_m",    "true_y_m",    "true_heading_rad",
                                            "sigma_x_m",   "sigma_y_m",   "sigma_heading_rad",
                                            "ticks_missed"};
  const auto table = vision::CsvTable::load(file, columns);
  if (table.rows() == 0) {
    throw vision::InputError({file.string(), 0, 0}, "the drive has no rows",
                             "a client without a pose writes none");
  }
  DriveRecord record{file.stem().string(), {}};
  record.rows.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](std::size_t column) { return table.number(row, column); };
    const auto pose = [&](std::size_t column) {
      return fusion::PlanarPose{number(column), number(column + 1), number(column + 2)};
    };
    const std::string& mode = table.text(row, 0);
    DriveRow tick;
    tick.drives = mode == "driving" || mode == "slow";
    tick.slowed = mode == "slow" || mode == "stopped" || mode == "emergency";
    tick.follows = tick.drives && table.text(row, 1) == "follow";
    tick.time_s = number(2);
    tick.command = pose(3);
    tick.nominal = pose(6);
    tick.estimate = pose(9);
    tick.encoders = pose(12);
    tick.truth = pose(15);
    tick.sigma = {number(18), number(19), number(20)};
    tick.ticks_missed = number(21);
    record.rows.push_back(tick);
  }
  return record;
}

}  // namespace nadir::control_client
