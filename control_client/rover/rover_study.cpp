#include "control_client/rover/rover_study.h"

#include <vector>

#include "control_client/rover/rover_case.h"
#include "control_client/rover/rover_report.h"

namespace nadir::control_client {

Study e11_study() {
  const auto run = [](const StudyRuns& runs) {
    const RoverWorld world;
    const std::vector<RoverVariant> variants = rover_variants();
    std::vector<RoverCase> cases;
    for (const RoverVariant& variant : variants) {
      cases.push_back(run_rover_case(world, variant, runs.first_seed, runs.runs));
      if (runs.progress) runs.progress(cases.size(), variants.size());
    }
    return StudyResult{rover_text(cases), rover_json(cases, runs.first_seed),
                       rover_figure(world, cases)};
  };
  return {"e11", "S4: a rover maps landmarks on a tour, with and without disturbance observer", 0,
          20, run};
}

}  // namespace nadir::control_client
