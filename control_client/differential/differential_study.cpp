#include "control_client/differential/differential_study.h"

#include <utility>

#include "control_client/differential/differential_report.h"

namespace nadir::control_client {
namespace {

Study study(std::string name, std::string description,
            std::vector<DifferentialCase> (*make_cases)(), DifferentialLook look) {
  const auto run = [name, make_cases, look](const StudyRuns& runs) {
    const std::vector<DifferentialCase> cases = make_cases();
    std::vector<DifferentialResult> results;
    for (const DifferentialCase& each : cases) {
      results.push_back(run_case(each, runs.first_seed, runs.runs));
      if (runs.progress) runs.progress(results.size(), cases.size());
    }
    return StudyResult{differential_text(results, look),
                       differential_json(name, results, runs.first_seed),
                       differential_figure(results, look)};
  };
  return {std::move(name), std::move(description), 0, 20, run};
}

}  // namespace

Study e8_study() {
  return study("e8", "S1: a robot with two driven wheels is kicked on two L shapes", l_shape_cases,
               {.drawn = {"truth", "filter", "wheels", "klancar"}});
}

Study e9_study() {
  return study("e9", "S1: the same robot on two circles, with and without feed-forward",
               two_circle_cases,
               {.drawn = {"feed-forward-filter", "feedback-filter", "integral-truth"}});
}

Study e10_study() {
  return study("e10", "S1: weights of the error to the side against overshoot on a square",
               square_cases,
               {.drawn = {"q2-5", "q2-50", "q2-500", "q2-5000"}, .shows_overshoot = true});
}

}  // namespace nadir::control_client
