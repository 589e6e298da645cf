#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace nadir::calibration {

// The subcommands of nadir-calibrate. Each adds itself with its options to the program and runs in
// its callback, that is in app.parse(). It throws InputError for bad input (exit 2) and any other
// std::exception where the job failed (exit 1).
void add_field_command(CLI::App& app);
void add_validate_command(CLI::App& app);
void add_noise_command(CLI::App& app);
void add_colours_command(CLI::App& app);
void add_compare_command(CLI::App& app);

/// A number in a closed range; CLI11's own ranges let a NaN pass.
CLI::Validator number_from_to(double low, double high);

}  // namespace nadir::calibration
