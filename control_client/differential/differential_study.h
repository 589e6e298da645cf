#pragma once

#include "control_client/differential/differential_cases.h"
#include "control_client/experiment/study.h"

namespace nadir::control_client {

/// e8: S1's two L shapes with a kick; e9: its two circles; e10: its weights on a square (theory 9,
/// table 12.8).
Study e8_study();
Study e9_study();
Study e10_study();

}  // namespace nadir::control_client
