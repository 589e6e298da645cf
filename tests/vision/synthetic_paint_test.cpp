#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/vision/synthetic_test_scenes.h"
#include "vision/synthetic/random_stream.h"
#include "vision/synthetic/sprite.h"

namespace nadir::vision {
namespace {

CameraParameters test_camera(double pixels_per_metre) {
  CameraParameters camera;
  camera.width_px = 320;
  camera.height_px = 240;
  camera.centre_u_px = 150.0;
  camera.centre_v_px = 125.0;
  camera.focal_px = 500.0;
  camera.height_m = 0.1 + 500.0 / pixels_per_metre;
  camera.tilt_rad = 0.1;
  camera.tilt_direction_rad = 1.0;
  camera.k1 = -0.1;
  return camera;
}

Sprite disc_at(double radius_m, const Eigen::Vector2d& place_m) {
  Sprite sprite;
  sprite.height_m = 0.1;
  sprite.motion.x_m = place_m.x();
  sprite.motion.y_m = place_m.y();
  Sprite::Disc disc;
  disc.radius_m = radius_m;
  sprite.discs = {disc};
  return sprite;
}

/// Area and centroid of the exact image of a circle, by a polygon of 4096 corners (Green's
/// theorem).
Eigen::Vector3d circle_image(const CameraModel& camera, const Eigen::Vector2d& place_m,
                             double radius_m) {
  const PixelPoint origin = camera.project({place_m.x(), place_m.y(), 0.1});
  const auto corner = [&](int i) -> PixelPoint {
    const double angle = 2.0 * std::numbers::pi * i / 4096;
    return camera.project({place_m.x() + radius_m * std::cos(angle),
                           place_m.y() + radius_m * std::sin(angle), 0.1}) -
           origin;
  };
  double area = 0.0;
  PixelPoint moment = PixelPoint::Zero();
  for (int i = 0; i < 4096; ++i) {
    const PixelPoint a = corner(i);
    const PixelPoint b = corner(i + 1);
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += 0.5 * cross;
    moment += cross * (a + b) / 6.0;
  }
  return {origin.x() + moment.x() / area, origin.y() + moment.y() / area, std::abs(area)};
}

/// The same of a painted patch.
Eigen::Vector3d patch_moments(const SpritePatch& patch) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int v = 0; v < patch.region_px.height; ++v) {
    for (int u = 0; u < patch.region_px.width; ++u) {
      const double coverage = patch.premultiplied.at<cv::Vec4f>(v, u)[3];
      sum += coverage * Eigen::Vector3d(patch.region_px.x + u, patch.region_px.y + v, 1.0);
    }
  }
  return {sum.x() / sum.z(), sum.y() / sum.z(), sum.z()};
}

struct PaintCase {
  double radius_px;
  double point_spread_px;
  double centroid_tolerance_px;
};

/// Worst error of centroid (px) and area (share) of 200 discs at random places.
struct PaintError {
  double centroid_px = 0.0;
  double area = 0.0;
};

PaintError worst_error(double radius_px, double point_spread_px, int samples_per_px) {
  const CameraModel camera(test_camera(radius_px / 0.025));
  SpritePainter painter(camera, point_spread_px, 0.0, samples_per_px);
  RandomStream random(11);
  PaintError worst;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d place_m =
        camera.on_plane({random.uniform(60, 260), random.uniform(60, 180)}, 0.1);
    SpritePatch patch;
    painter.paint(disc_at(0.025, place_m), nullptr, patch);
    const Eigen::Vector3d painted = patch_moments(patch);
    const Eigen::Vector3d exact = circle_image(camera, place_m, 0.025);
    worst.centroid_px = std::max(worst.centroid_px, (painted - exact).head<2>().norm());
    worst.area = std::max(worst.area, std::abs(painted.z() / exact.z() - 1.0));
  }
  return worst;
}

class PaintedDisc : public testing::TestWithParam<PaintCase> {};

TEST_P(PaintedDisc, CentroidAndAreaAreThoseOfTheExactImage) {
  const PaintCase& given = GetParam();
  const PaintError worst = worst_error(given.radius_px, given.point_spread_px, 0);
  EXPECT_LT(worst.centroid_px, given.centroid_tolerance_px);
  EXPECT_LT(worst.area, 0.005);
}

TEST(SpritePainter, TwoSamplesAPixelAreTrueToTwoHundredthsOfAPixel) {
  for (const double radius_px : {5.0, 6.0, 7.5}) {
    const PaintError worst = worst_error(radius_px, 0.7, 2);
    EXPECT_LT(worst.centroid_px, 0.02) << radius_px;
    EXPECT_LT(worst.area, 0.01) << radius_px;
  }
}

// Without any blur even exact pixel values have a centroid some 0.004 px beside that of the area:
// aliasing.
INSTANTIATE_TEST_SUITE_P(SizesAndOptics, PaintedDisc,
                         testing::Values(PaintCase{1.6, 0.7, 0.003}, PaintCase{2.1, 0.7, 0.003},
                                         PaintCase{4.3, 0.7, 0.003}, PaintCase{5.3, 0.4, 0.003},
                                         PaintCase{7.0, 0.7, 0.003}, PaintCase{14.0, 1.5, 0.003},
                                         PaintCase{5.3, 0.0, 0.006}));

/// What the scene sends from one point of the image, without any smoothing: the definition of the
/// picture.
Eigen::Vector4d radiance(const CameraModel& camera, const Sprite& sprite, const ShadowEdge& shadow,
                         const PixelPoint& pixel) {
  const Eigen::Vector2d place = camera.on_plane(pixel, sprite.height_m);
  const Eigen::Vector2d from(place.x() - sprite.motion.x_m, place.y() - sprite.motion.y_m);
  const double c = std::cos(sprite.motion.heading_rad);
  const double s = std::sin(sprite.motion.heading_rad);
  const Eigen::Vector2d local(c * from.x() + s * from.y(), -s * from.x() + c * from.y());
  const double light = shadow.factor_at(shadow.distance_px(pixel.x(), pixel.y()));
  Eigen::Vector4d seen = Eigen::Vector4d::Zero();
  const auto cover = [&](const Reflectance& colour) {
    seen = {light * colour[0], light * colour[1], light * colour[2], 1.0};
  };
  if (local.norm() < sprite.body->radius_m && local.x() < sprite.body->front_m) {
    cover(sprite.body->colour);
  }
  for (const Sprite::Disc& disc : sprite.discs) {
    if ((local - disc.position_m).norm() < disc.radius_m) cover(disc.colour);
  }
  return seen;
}

TEST(SpritePainter, AgreesWithBruteForceSamplingOfTheOptics) {
  const CameraModel camera(test_camera(212.0));
  const double sigma_px = 0.7;
  SpritePainter painter(camera, sigma_px, 0.0);
  Sprite sprite = disc_at(0.025, camera.on_plane({140.3, 110.6}, 0.1));
  sprite.discs[0].colour = {0.9F, 0.5F, 0.1F};
  sprite.discs.push_back({{0.035, 0.0547}, 0.02, {0.6F, 0.2F, 1.0F}, 0.0});
  sprite.motion.heading_rad = 0.6;
  sprite.body = RobotBody{0.09, 0.065, {0.15F, 0.15F, 0.15F}};
  SceneShadow edge;
  edge.u_px = 141.0;
  edge.v_px = 110.0;
  edge.softness_px = 0.5;
  const ShadowEdge shadow(edge, 0.0);
  SpritePatch patch;
  painter.paint(sprite, &shadow, patch);

  double worst = 0.0;
  for (int v = 0; v < patch.region_px.height; v += 3) {
    for (int u = 0; u < patch.region_px.width; u += 3) {
      // Midpoint rule over the pixel's square and 4 sigma around it, weights of the point spread.
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      double weights = 0.0;
      const int half = 66;
      for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
          const double du = 0.05 * (i + 0.37);
          const double dv = 0.05 * (j + 0.41);
          const auto share = [&](double d) {
            return std::erf((d + 0.5) / (sigma_px * std::numbers::sqrt2)) -
                   std::erf((d - 0.5) / (sigma_px * std::numbers::sqrt2));
          };
          const double weight = share(du) * share(dv);
          weights += weight;
          const PixelPoint at(patch.region_px.x + u + du, patch.region_px.y + v + dv);
          sum += weight * radiance(camera, sprite, shadow, at);
        }
      }
      sum /= weights;
      const auto& painted = patch.premultiplied.at<cv::Vec4f>(v, u);
      for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(sum[c] - painted[c]));
    }
  }

  EXPECT_LT(worst, 0.005);
}

TEST(SpritePainter, MotionBlurIsCentredOnMidExposureAndAsLongAsTheTravel) {
  CameraParameters parameters = test_camera(212.0);
  parameters.tilt_rad = 0.0;
  parameters.k1 = 0.0;
  const CameraModel camera(parameters);
  const double exposure_s = 0.010;
  SpritePainter moving(camera, 0.7, exposure_s);
  SpritePainter still(camera, 0.7, 0.0);
  Sprite sprite = disc_at(0.025, camera.on_plane({140.3, 110.6}, 0.1));
  sprite.motion.velocity_x_mps = 3.0;
  SpritePatch blurred;
  SpritePatch sharp;
  moving.paint(sprite, nullptr, blurred);
  still.paint(sprite, nullptr, sharp);
  EXPECT_LT((patch_moments(blurred) - patch_moments(sharp)).head<2>().norm(), 0.002);

  const auto spread_u = [](const SpritePatch& patch) {
    const Eigen::Vector3d moments = patch_moments(patch);
    double sum = 0.0;
    for (int v = 0; v < patch.region_px.height; ++v) {
      for (int u = 0; u < patch.region_px.width; ++u) {
        const double away = patch.region_px.x + u - moments.x();
        sum += patch.premultiplied.at<cv::Vec4f>(v, u)[3] * away * away;
      }
    }
    return sum / moments.z();
  };
  // A uniform smear of length L adds a variance of L^2 / 12.
  const double travel_px = 3.0 * exposure_s * 212.0;
  EXPECT_NEAR(spread_u(blurred) - spread_u(sharp), travel_px * travel_px / 12.0, 0.02);
}

TEST(SpritePainter, PaintsNothingOutsideTheImage) {
  const CameraModel camera(test_camera(212.0));
  SpritePainter painter(camera, 0.7, 0.0);
  SpritePatch patch;
  painter.paint(disc_at(0.025, {50.0, 0.0}), nullptr, patch);
  EXPECT_TRUE(patch.region_px.empty());
  const Eigen::Vector2d corner_m = camera.on_plane({0.0, 0.0}, 0.1);
  painter.paint(disc_at(0.025, corner_m), nullptr, patch);
  EXPECT_EQ(patch.region_px & cv::Rect(0, 0, 320, 240), patch.region_px);
  EXPECT_GT(patch.region_px.area(), 0);
}

}  // namespace
}  // namespace nadir::vision
