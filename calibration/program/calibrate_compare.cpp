// nadir-calibrate compare: where and how much two calibrations of one camera differ.

#include <cmath>
#include <iostream>
#include <memory>

#include "calibration/calibration_file.h"
#include "calibration/compare/compare_maps.h"
#include "calibration/compare/compare_text.h"
#include "calibration/program/calibrate_commands.h"
#include "vision/input/text_file.h"

namespace nadir::calibration {
namespace {

struct CompareOptions {
  std::string first;
  std::string second;
  std::string json;
};

void run(const CompareOptions& options) {
  constexpr double kSameHeight_m = 0.001;
  const Calibration a = load_calibration(options.first);
  const Calibration b = load_calibration(options.second);
  const MapComparison comparison = compare_maps(a, b, options.first, options.second);
  if (!options.json.empty()) vision::write_text_file(options.json, comparison_json(comparison));
  std::ostream& out = options.json == "-" ? std::cerr : std::cout;
  out << comparison_summary(comparison) << std::flush;
  if (std::abs(a.height_m - b.height_m) > kSameHeight_m) {
    std::cerr << "note: they are made for planes at " << a.height_m << " and " << b.height_m
              << " m: parallax is part of the difference\n";
  }
}

}  // namespace

void add_compare_command(CLI::App& app) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "says where and how much two calibrations differ");
  command->add_option("first", options->first, "calibration file")->required();
  command->add_option("second", options->second, "another one of the same camera")->required();
  command->add_option("--json", options->json, "difference map as JSON; - is stdout");
  command->footer("Example: nadir-calibrate compare before.yaml after.yaml --json difference.json");
  command->callback([options] { run(*options); });
}

}  // namespace nadir::calibration
