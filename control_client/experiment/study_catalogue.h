#pragma once

#include <string>
#include <vector>

#include "control_client/experiment/study.h"

namespace nadir::control_client {

/// All studies of nadir-client, in the order in which they are listed.
const std::vector<Study>& studies();
/// Null if none has this name.
const Study* find_study(const std::string& name);

}  // namespace nadir::control_client
