#include "control_client/experiment/study_catalogue.h"

#include <algorithm>

#include "control_client/differential/differential_study.h"
#include "control_client/rover/rover_study.h"

namespace nadir::control_client {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {e8_study(), e9_study(), e10_study(), e11_study()};
  return all;
}

const Study* find_study(const std::string& name) {
  const auto& all = studies();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Study& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace nadir::control_client
