#pragma once

#include <array>
#include <string>
#include <vector>

#include "control_client/rover/rover_navigator.h"

namespace nadir::control_client {

/// A way to navigate that experiment e11 compares.
struct RoverVariant {
  std::string name;
  std::string label;
  bool looks_first = true;  ///< RoverWorld
  NavigatorSettings settings;
};

/// S4's gains as printed (lx, lv, ld), the same for all axes: unstable (theory 10, item 32).
inline constexpr fusion::ObserverGains kPrintedObserver{10.0, 0.2, 100.0};

/// An observer of this bandwidth on all axes of a rover.
std::array<fusion::ObserverGains, 3> observer_of_bandwidth(double bandwidth_radps,
                                                           const RoverParameters& rover);

/// First the rows of theory 12.7 as there: S4's filter (the textbook's error, one landmark after
/// the other), the first look a tick after the start, the map's prediction believed to 0.05 m/s and
/// rad/s with an observer and to 0.15 without. Then those that look before they drive, with the
/// invariant error and all landmarks at once, and one noise for all: a tight one, which only the
/// observer keeps to, and a wide one.
std::vector<RoverVariant> rover_variants();

}  // namespace nadir::control_client
