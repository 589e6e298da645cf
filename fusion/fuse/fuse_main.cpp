// nadir-fuse: the robot's fusion over recorded logs.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>

#include "fusion/fuse/fuse_config.h"
#include "fusion/fuse/fuse_logs.h"
#include "fusion/fuse/fuse_report.h"
#include "fusion/fuse/fuse_run.h"
#include "fusion/fuse/fuse_score.h"
#include "fusion/fuse/fuse_smooth.h"
#include "vision/input/run_program.h"
#include "vision/input/text_file.h"
#include "vision/input/usage_line.h"

namespace {

struct Options {
  std::string odometry;
  std::string poses;
  std::string filter;
  std::string config;
  std::string nominal;
  std::string truth;
  std::string output;
  std::string json;
  std::string smooth;
  bool print_config = false;
};

void describe_options(CLI::App& app, Options& options) {
  app.failure_message(nadir::vision::usage_line);
  app.set_version_flag("--version", "nadir-fuse " NADIR_VERSION);
  app.footer(
      "Example: nadir-fuse --odometry odo.csv --poses vision.csv --filter ekf --truth truth.csv "
      "-o estimates.csv");
  app.add_option("--odometry", options.odometry,
                 "t_s,u_mps,v_mps,r_radps, valid up to the next row")
      ->type_name("ODO.csv");
  app.add_option("--poses", options.poses,
                 "t_capture_s,t_arrival_s,x_m,y_m,heading_rad,var_x_m2,var_y_m2,var_heading_rad2 "
                 "in order of arrival")
      ->type_name("VIS.csv");
  app.add_option("--filter", options.filter,
                 "line of linearization: nominal trajectory, or the estimate itself (ekf)")
      ->check(CLI::IsMember({"nominal", "ekf"}))
      ->type_name("nominal|ekf");
  app.add_option("--config", options.config, "settings; see --print-config")->type_name("F.yaml");
  app.add_option(
         "--nominal", options.nominal,
         "t_s,heading_rad,u_mps,v_mps,r_radps as planned, for --filter nominal; without it, "
         "the estimate of the moment")
      ->type_name("NOM.csv");
  app.add_option("--truth", options.truth, "t_s,x_m,y_m,heading_rad to compare with")
      ->type_name("T.csv");
  app.add_option("-o,--output", options.output, "estimates, a row an odometry row; - is stdout")
      ->type_name("EST.csv");
  app.add_option("--json", options.json, "errors, consistency, verdicts; - is stdout")
      ->type_name("SUMMARY.json");
  app.add_option("--smooth", options.smooth,
                 "the same rows by all of the logs, the future included (a reference)")
      ->type_name("FILE");
  app.add_flag("--print-config", options.print_config, "print the effective settings and end");
}

void check_usage(const Options& options) {
  const auto require = [](const std::string& value, const char* name) {
    if (value.empty()) throw CLI::RequiredError(name);
  };
  require(options.odometry, "--odometry");
  require(options.poses, "--poses");
  require(options.filter, "--filter");
  require(options.output, "--output");
  if (options.output == "-" && options.json == "-") {
    throw CLI::ValidationError("-o and --json both want stdout; give one of them a file");
  }
  if (!options.nominal.empty() && options.filter != "nominal") {
    throw CLI::ValidationError("--nominal goes with --filter nominal");
  }
}

void run(const Options& options) {
  nadir::fusion::FuseConfig config;
  if (!options.config.empty()) config = nadir::fusion::load_fuse_config(options.config);
  if (options.print_config) {
    nadir::vision::write_text_file("-", fuse_config_yaml(config));
    return;
  }
  check_usage(options);
  nadir::fusion::FuseLogs logs;
  logs.odometry = nadir::fusion::load_odometry(options.odometry);
  logs.vision = nadir::fusion::load_vision(options.poses);
  if (!options.nominal.empty()) logs.nominal = nadir::fusion::load_nominal(options.nominal);
  std::optional<nadir::fusion::TruthLine> truth;
  if (!options.truth.empty()) truth.emplace(nadir::fusion::load_truth(options.truth));

  const auto kind = options.filter == "nominal" ? nadir::fusion::FilterKind::kNominal
                                                : nadir::fusion::FilterKind::kEkf;
  const auto result = nadir::fusion::fuse(logs, config, kind);
  std::optional<nadir::fusion::FuseScore> errors;
  if (truth) errors = score(result.estimates, *truth);
  nadir::vision::write_text_file(options.output, estimates_csv(result.estimates));
  if (!options.json.empty())
    nadir::vision::write_text_file(options.json, summary_json(result, errors));
  std::cerr << summary_text(result, errors, options.poses);
  if (options.smooth.empty()) return;
  const auto smoothed = nadir::fusion::smooth(logs, config);
  nadir::vision::write_text_file(options.smooth, estimates_csv(smoothed));
  if (truth) std::cerr << "smoothed: " << score_text(score(smoothed, *truth));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Fuses logs of odometry and late poses as the robot does, one estimate a row.",
               "nadir-fuse");
  describe_options(app, options);
  return nadir::vision::run_program(app, argc, argv, [&] { run(options); });
}
