#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vision/synthetic/camera_model.h"
#include "vision/synthetic/local_plane_map.h"
#include "vision/synthetic/robot_path.h"
#include "vision/synthetic/scene.h"
#include "vision/synthetic/scene_light.h"
#include "vision/synthetic/tag_paint.h"

namespace nadir::vision {

/// Round marks and tags on one plane, with or without a plate under them, at one place: a robot or
/// a ball.
struct Sprite {
  struct Disc {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< in the sprite's own frame
    double radius_m = 0.0;
    Reflectance colour = {1, 1, 1};
    double shading =
        0.0;  ///< share of light lost at the rim, growing with the square of the radius
  };

  double height_m = 0.0;
  RobotMotion motion;
  std::optional<RobotBody> body;
  std::vector<Disc> discs;
  std::vector<PaintedTag> tags;

  /// Radius of a circle about the origin that holds everything.
  double extent_m() const;
};

/// A painted sprite as the optics shows it: reflectance times shadow, blurred and integrated over
/// the pixels.
struct SpritePatch {
  cv::Rect region_px;     ///< part of the image; may be empty
  cv::Mat premultiplied;  ///< CV_32FC4 of that size: blue, green, red times coverage, then coverage
};

/// Paints sprites. Edges are drawn by their signed distance on a grid 4 or 8 times finer than the
/// pixels, then convolved with the exact pixel-integrated point spread, so that the paint's own
/// centroid error is below 0.003 px. Reuses its memory; one per thread.
class SpritePainter {
 public:
  /// samples_per_px: of the fine grid; 0 takes 8 for small sprites and sharp optics, else 4. With 2
  /// a sprite costs a quarter and its centroid is wrong by up to 0.02 px.
  SpritePainter(const CameraModel& camera, double point_spread_px, double exposure_s,
                int samples_per_px = 0);

  /// `shadow` may be null: even light.
  void paint(const Sprite& sprite, const ShadowEdge* shadow, SpritePatch& patch);

 private:
  /// A shape of a sprite in one instant of the exposure, and where to look for it on the fine grid.
  struct Layer {
    const Sprite::Disc* disc = nullptr;  ///< null: the body or a tag
    const PaintedTag* tag = nullptr;
    double column = 0.0;
    double row = 0.0;
    double reach = 0.0;
  };
  /// A pose within the exposure.
  struct Instant {
    Eigen::Vector2d place_m;
    double cosine = 1.0;
    double sine = 0.0;
    float fine_per_metre = 0.0F;
    std::vector<Layer> layers;
  };

  cv::Rect region_of(const Sprite& sprite) const;
  int instants_of(const Sprite& sprite) const;
  void prepare_instants(const Sprite& sprite, const cv::Rect& region);
  void paint_fine_row(const Sprite& sprite, const LocalPlaneMap& map, int row, double v_px);
  void cover_shape(const Sprite& sprite, const Instant& instant, const Layer& layer, int begin,
                   int end);
  void paint_layer(const Sprite& sprite, const Instant& instant, const Layer& layer, int row);
  void shade_fine_row(const ShadowEdge& shadow, int row, double first_u_px, double v_px);
  void blur_into(SpritePatch& patch);
  void set_fineness(int fineness);

  CameraModel camera_;
  double point_spread_px_;
  double exposure_s_;
  int margin_px_;  ///< of the point spread around a pixel
  int samples_per_px_;
  int fineness_ = 0;  ///< fine columns per pixel
  int fine_columns_ = 0;
  int fine_rows_ = 0;
  double fine_origin_u_px_ = 0.0;  ///< centre of fine column 0
  double fine_origin_v_px_ = 0.0;
  std::vector<float> taps_;
  std::vector<Instant> instants_;
  std::vector<float> local_x_;
  std::vector<float> local_y_;
  std::vector<float> coverage_;
  std::vector<float> shares_;
  std::vector<Eigen::Array4f> row_;
  std::vector<Eigen::Array4f> fine_;
  std::vector<Eigen::Array4f> half_blurred_;
};

}  // namespace nadir::vision
