#pragma once

#include "control_client/experiment/study.h"

namespace nadir::control_client {

/// e11: S4's tour with and without observer (theory 9, table 12.7).
Study e11_study();

}  // namespace nadir::control_client
