#pragma once

#include <vector>

#include "fusion/fuse/fuse_config.h"
#include "fusion/fuse/fuse_logs.h"
#include "fusion/fuse/fuse_run.h"

namespace nadir::fusion {

/// The poses at the odometry rows by all of the logs, what came later included (Smoother): a
/// reference for what fuse knew at the time. The filter is the EKF with the same settings; poses
/// are used in the order of capture, whenever they arrived; rows that make no sense are left out.
std::vector<EstimateRow> smooth(const FuseLogs& logs, const FuseConfig& config);

}  // namespace nadir::fusion
