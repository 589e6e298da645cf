// nadir-evaluate: a tracker's poses against the truth of the recording.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>

#include "tracker/evaluation/evaluation.h"
#include "tracker/evaluation/evaluation_logs.h"
#include "tracker/evaluation/evaluation_text.h"
#include "vision/input/run_program.h"
#include "vision/input/text_file.h"
#include "vision/input/usage_line.h"

namespace {

struct Options {
  std::string truth;
  std::string poses;
  std::string received;
  std::string json;
  nadir::tracker::EvaluationOptions evaluation;
};

void describe_options(CLI::App& app, Options& options) {
  app.failure_message(nadir::vision::usage_line);
  app.set_version_flag("--version", "nadir-evaluate " NADIR_VERSION);
  app.footer("Example: nadir-evaluate clip/truth.jsonl poses.jsonl --json errors.json");
  app.add_option("truth", options.truth, "where the robots were (nadir-render's truth.jsonl)")
      ->type_name("TRUTH.jsonl")
      ->required();
  app.add_option("poses", options.poses, "what the tracker said (nadir-tracker --poses)")
      ->type_name("POSES.jsonl")
      ->required();
  app.add_option("--received", options.received, "what arrived elsewhere (nadir-listen --json)")
      ->type_name("RECEIVED.jsonl");
  app.add_option("--json", options.json, "write all figures into this file, too")
      ->type_name("FILE");
  app.add_option("--radius", options.evaluation.radius_m,
                 "a pose farther from a robot than this is not that robot's, metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--anonymous", options.evaluation.anonymous,
               "the robots show no number: pair by place, count changes of track numbers");
}

void run(const Options& options) {
  const auto truth = nadir::tracker::read_truth(options.truth);
  const auto poses = nadir::tracker::read_poses(options.poses);
  std::optional<nadir::tracker::Reception> reception;
  if (!options.received.empty()) {
    reception = judge_reception(poses, nadir::tracker::read_received(options.received));
  }
  const auto evaluation = evaluate(truth, poses, options.evaluation);
  const auto stages = nadir::tracker::summarise_stages(poses);
  std::fputs(evaluation_table(evaluation, stages, reception).c_str(), stdout);
  if (!options.json.empty()) {
    nadir::vision::write_text_file(options.json, evaluation_json(evaluation, stages, reception));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Compares a tracker's poses with the truth: error, honesty, names, times.",
               "nadir-evaluate");
  describe_options(app, options);
  return nadir::vision::run_program(app, argc, argv, [&] { run(options); });
}
