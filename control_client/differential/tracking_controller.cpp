#include "control_client/differential/tracking_controller.h"

#include <algorithm>
#include <cmath>

namespace nadir::control_client {
namespace {

UnicycleMotion wanted(const KlancarSettings& settings, const UnicycleReference& reference,
                      const Eigen::Vector3d& error) {
  const double v = reference.motion.speed_mps;
  const double w = reference.motion.turn_rate_radps;
  const double gain = 2.0 * settings.damping * std::sqrt(w * w + settings.stiffness_per_m2 * v * v);
  const double e3 = error.z();
  const double sinc = std::abs(e3) < 1e-6 ? 1.0 : std::sin(e3) / e3;
  return {v * std::cos(e3) + gain * error.x(),
          w + settings.stiffness_per_m2 * v * sinc * error.y() + gain * e3};
}

}  // namespace

UnicycleMotion limited(const UnicycleMotion& wanted, const UnicycleLimits& limits) {
  if (limits.keeps_curvature) {
    const double excess = std::max({1.0, std::abs(wanted.speed_mps) / limits.speed_mps,
                                    std::abs(wanted.turn_rate_radps) / limits.turn_rate_radps});
    return {wanted.speed_mps / excess, wanted.turn_rate_radps / excess};
  }
  return {std::clamp(wanted.speed_mps, -limits.speed_mps, limits.speed_mps),
          std::clamp(wanted.turn_rate_radps, -limits.turn_rate_radps, limits.turn_rate_radps)};
}

UnicycleMotion TrackingController::wanted(const DecentralisedSettings& settings,
                                          const UnicycleReference& reference,
                                          const Eigen::Vector3d& error) const {
  const Eigen::Vector2d correction = settings.gains * error;
  const double forward = reference.motion.speed_mps * std::cos(error.z());
  const double turn = settings.feeds_turn_rate_forward ? reference.motion.turn_rate_radps : 0.0;
  return {forward + correction.x() + settings.integral_ahead_per_s2 * integral_.x(),
          turn + correction.y() + settings.integral_side * integral_.y()};
}

UnicycleMotion TrackingController::command(const UnicycleReference& reference,
                                           const fusion::PlanarPose& pose, double period_s) {
  const Eigen::Vector3d error = tracking_error(reference, pose);
  const auto* const decentralised = std::get_if<DecentralisedSettings>(&settings_);
  const UnicycleMotion asked =
      decentralised != nullptr
          ? wanted(*decentralised, reference, error)
          : control_client::wanted(std::get<KlancarSettings>(settings_), reference, error);
  const UnicycleMotion possible = limited(asked, limits_);
  saturated_ =
      possible.speed_mps != asked.speed_mps || possible.turn_rate_radps != asked.turn_rate_radps;
  if (!saturated_) integral_ += period_s * error.head<2>();
  return possible;
}

}  // namespace nadir::control_client
