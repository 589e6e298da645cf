#pragma once

#include <string>
#include <vector>

namespace nadir::bench {

/// What an independent simulation of the same scenario gave.
struct ControlReference {
  std::string experiment;  ///< of nadir-client list
  std::string label;       ///< of the case
  std::string driver;      ///< who drove; empty: whoever did
  std::string estimator;   ///< whose estimate; empty: how the robot drove
  double position_mm = 0.0;
  double heading_deg = 0.0;  ///< 0: not given
};

/// The tables of estimation and tracking: root mean square errors.
const std::vector<ControlReference>& control_references();

}  // namespace nadir::bench
