#include "control_client/slip_tolerance.h"

#include <algorithm>

namespace nadir::control_client {

ControlParameters tolerating_slip(const RobotModel& model, ControlParameters control) {
  const double slip_s = control.tolerated_slip_s;
  if (slip_s <= 0.0) return control;
  constexpr double kShare = 0.5;  // of what is stable
  const double least_damping_per_s = model.damping_per_s().diagonal().minCoeff();
  LoopParameters& inner = control.inner;
  const double by_proportional_radps =
      (least_damping_per_s + kShare / slip_s) / (2.0 * inner.damping);
  const double by_integral_radps = kShare * 2.0 * inner.damping / slip_s;
  inner.natural_frequency_radps =
      std::min({inner.natural_frequency_radps, by_proportional_radps, by_integral_radps});
  return control;
}

}  // namespace nadir::control_client
