#pragma once

#include <cstdint>
#include <vector>

#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// The smooth part of a scene's light: level, colour, vignette and gradient.
class LightField {
 public:
  LightField(const SceneLight& light, int width_px, int height_px);

  /// Grey levels of a perfectly white surface at a pixel, blue green red.
  cv::Vec3f grey_levels(double u_px, double v_px) const {
    const double u = (u_px - centre_u_px_) * per_half_diagonal_;
    const double v = (v_px - centre_v_px_) * per_half_diagonal_;
    const double share =
        (1.0 - vignette_ * (u * u + v * v)) *
        (1.0 + gradient_u_ * (u_px - centre_u_px_) + gradient_v_ * (v_px - centre_v_px_));
    return peak_ * static_cast<float>(share > 0.0 ? share : 0.0);
  }

 private:
  cv::Vec3f peak_;
  double centre_u_px_;
  double centre_v_px_;
  double per_half_diagonal_;
  double vignette_;
  double gradient_u_;  ///< per px
  double gradient_v_;
};

/// The light that a shadow leaves, across its straight edge.
class ShadowEdge {
 public:
  /// `extra_blur_px` is added to the softness, in squares.
  ShadowEdge(const SceneShadow& shadow, double extra_blur_px);

  /// Signed distance to the edge, positive on the lit side.
  double distance_px(double u_px, double v_px) const {
    return normal_u_ * (u_px - u_px_) + normal_v_ * (v_px - v_px_);
  }
  float factor_at(double distance_px) const;
  /// Factors of `count` places of one row, `step_px` apart.
  void factors(double first_u_px, double step_px, double v_px, int count, float* factors) const;
  /// Distance beyond which the light is whole or the shadow deepest.
  double reach_px() const { return reach_px_; }

 private:
  double u_px_;
  double v_px_;
  double normal_u_;
  double normal_v_;
  double reach_px_;
  double factor_;
  std::vector<float> profile_;
};

/// The frame's shadow: the scene's own, or a new random edge through the middle half of the image.
SceneShadow shadow_in_frame(const SceneShadow& shadow, int width_px, int height_px,
                            std::uint64_t seed, std::uint64_t frame_number);

}  // namespace nadir::vision
