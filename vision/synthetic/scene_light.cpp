#include "vision/synthetic/scene_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr std::uint64_t kShadowPurpose = 3;
constexpr int kProfileSteps = 2048;
constexpr double kReachInSigmas = 4.5;
constexpr double kSharpestEdgePx = 0.02;

}  // namespace

LightField::LightField(const SceneLight& light, int width_px, int height_px)
    : centre_u_px_(0.5 * (width_px - 1)),
      centre_v_px_(0.5 * (height_px - 1)),
      per_half_diagonal_(2.0 / std::hypot(width_px, height_px)),
      vignette_(light.vignette),
      gradient_u_(light.gradient_u / width_px),
      gradient_v_(light.gradient_v / height_px) {
  peak_ = light.colour * static_cast<float>(light.level * light.white_grey);
}

ShadowEdge::ShadowEdge(const SceneShadow& shadow, double extra_blur_px)
    : u_px_(shadow.u_px),
      v_px_(shadow.v_px),
      normal_u_(std::sin(shadow.angle_rad)),
      normal_v_(-std::cos(shadow.angle_rad)),
      factor_(shadow.factor) {
  const double sigma_px = std::max(std::hypot(shadow.softness_px, extra_blur_px), kSharpestEdgePx);
  reach_px_ = kReachInSigmas * sigma_px;
  profile_.resize(kProfileSteps + 2);
  for (int i = 0; i < kProfileSteps + 2; ++i) {
    const double sigmas = kReachInSigmas * (2.0 * i / kProfileSteps - 1.0);
    const double lit = 0.5 * std::erfc(-sigmas / std::numbers::sqrt2);
    profile_[i] = static_cast<float>(factor_ + (1.0 - factor_) * lit);
  }
}

float ShadowEdge::factor_at(double distance_px) const {
  if (distance_px >= reach_px_) return 1.0F;
  if (distance_px <= -reach_px_) return static_cast<float>(factor_);
  const double place = (distance_px / reach_px_ + 1.0) * (0.5 * kProfileSteps);
  const int index = static_cast<int>(place);
  const auto share = static_cast<float>(place - index);
  return profile_[index] + share * (profile_[index + 1] - profile_[index]);
}

void ShadowEdge::factors(double first_u_px, double step_px, double v_px, int count,
                         float* factors) const {
  const double first_px = distance_px(first_u_px, v_px);
  for (int i = 0; i < count; ++i) factors[i] = factor_at(first_px + i * step_px * normal_u_);
}

SceneShadow shadow_in_frame(const SceneShadow& shadow, int width_px, int height_px,
                            std::uint64_t seed, std::uint64_t frame_number) {
  if (!shadow.random) return shadow;
  RandomStream random(seed, frame_number, kShadowPurpose);
  SceneShadow drawn = shadow;
  drawn.u_px = width_px * random.uniform(0.25, 0.75);
  drawn.v_px = height_px * random.uniform(0.25, 0.75);
  drawn.angle_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  return drawn;
}

}  // namespace nadir::vision
