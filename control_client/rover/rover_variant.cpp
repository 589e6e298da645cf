#include "control_client/rover/rover_variant.h"

#include <limits>

namespace nadir::control_client {
namespace {

const Eigen::Vector3d kWithObserver = Eigen::Vector3d::Constant(0.05);
const Eigen::Vector3d kWithoutObserver = Eigen::Vector3d::Constant(0.15);
/// The heading's is larger: wheels that break loose turn the light body by 0.2 rad/s in a tick.
const Eigen::Vector3d kTight(0.05, 0.05, 0.15);
const Eigen::Vector3d kWide = Eigen::Vector3d::Constant(0.15);

NavigatorSettings with_observer(const std::array<fusion::ObserverGains, 3>& gains) {
  NavigatorSettings settings;
  settings.velocity.observer = gains;
  settings.velocity_sigma = kWithObserver;
  // Names are never wrong here, and S4 has no gate.
  settings.slam.sighting_gate = std::numeric_limits<double>::infinity();
  settings.slam.most_landmarks = 20;
  return settings;
}

NavigatorSettings with_bandwidth(double radps) {
  return with_observer(observer_of_bandwidth(radps, RoverParameters{}));
}

NavigatorSettings without_observer(bool predicts_by_command) {
  NavigatorSettings settings = with_bandwidth(5.0);
  settings.velocity.kind = VelocityKind::kDifferences;
  settings.predicts_by_command = predicts_by_command;
  settings.velocity_sigma = kWithoutObserver;
  return settings;
}

/// The four ways with one noise, looking first.
void add_even(std::vector<RoverVariant>& variants, const std::string& name,
              const std::string& label, const Eigen::Vector3d& velocity_sigma) {
  const std::vector<RoverVariant> ways = {
      {"command", "by command", true, without_observer(true)},
      {"differences", "by differences", true, without_observer(false)},
      {"eso5", "observer, 5 rad/s", true, with_bandwidth(5.0)},
      {"eso10", "observer, 10 rad/s", true, with_bandwidth(10.0)},
  };
  for (RoverVariant way : ways) {
    way.name += name;
    way.label = label + way.label;
    way.settings.velocity_sigma = velocity_sigma;
    variants.push_back(way);
  }
}

/// S4's filter: the textbook's error, and one landmark after the other.
void map_as_s4(NavigatorSettings& settings) {
  settings.slam.error = fusion::ErrorKind::kTextbook;
  settings.corrects_one_by_one = true;
}

}  // namespace

std::array<fusion::ObserverGains, 3> observer_of_bandwidth(double bandwidth_radps,
                                                           const RoverParameters& rover) {
  const auto moved = fusion::gains_of_bandwidth(bandwidth_radps, rover.mass_kg);
  return {moved, moved, fusion::gains_of_bandwidth(bandwidth_radps, rover.inertia_kgm2)};
}

std::vector<RoverVariant> rover_variants() {
  NavigatorSettings proportional = with_bandwidth(10.0);
  proportional.gains.integral = 0.0;
  proportional.gains.derivative = 0.0;
  constexpr fusion::ObserverGains kSwapped{10.0, 100.0, 0.2};
  NavigatorSettings unscaled = without_observer(false);
  unscaled.gains.axis_scale.setOnes();
  std::vector<RoverVariant> variants = {
      {"command", "no observer, predicts by command", false, without_observer(true)},
      {"differences", "no observer, predicts by differences", false, without_observer(false)},
      {"eso5", "observer, 5 rad/s", false, with_bandwidth(5.0)},
      {"eso10", "observer, 10 rad/s", false, with_bandwidth(10.0)},
      {"eso10_p", "observer, 10 rad/s, P only", false, proportional},
      {"eso3", "observer, 3.33 rad/s", false, with_bandwidth(10.0 / 3.0)},
      {"eso_swapped", "observer 10/100/0.2", false, with_observer({kSwapped, kSwapped, kSwapped})},
      {"eso_printed", "observer 10/0.2/100, as printed", false,
       with_observer({kPrintedObserver, kPrintedObserver, kPrintedObserver})},
      {"unscaled_pid", "no observer, PID unscaled on heading", false, unscaled},
  };
  for (RoverVariant& variant : variants) map_as_s4(variant.settings);
  add_even(variants, "_tight", "looks first, tight: ", kTight);
  add_even(variants, "_wide", "looks first, wide: ", kWide);
  return variants;
}

}  // namespace nadir::control_client
