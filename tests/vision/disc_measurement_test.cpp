#include "vision/disc_measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <optional>

#include "tests/vision/detector_test_scenes.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr int kSize_px = 96;
constexpr double kScale_px_per_m = 250.0;

/// One blue disc on a dark plate with room around it, on the carpet.
class LoneDisc {
 public:
  explicit LoneDisc(double radius_px, Colour colour = Colour::kBlue)
      : radius_m_(radius_px / kScale_px_per_m),
        scene_(straight_scene(lone_disc_layout(radius_m_, colour), kSize_px, kSize_px,
                              kScale_px_per_m)) {
    scene_.bodies[0].radius_m = scene_.bodies[0].front_m = radius_m_ + 0.03;
  }
  Scene& scene() {
    renderer_.reset();
    return scene_;
  }
  const cv::Mat& picture(const PixelPoint& place, std::uint64_t frame = 0) {
    if (!renderer_) renderer_.emplace(scene_, 11);
    const RobotPlacement robot = robot_at(renderer_->camera(), scene_.layouts[0], place);
    renderer_->render_robots(frame, {&robot, 1}, bgr_);
    return bgr_;
  }
  MeasureOutcome measure(const PixelPoint& start, DiscMeasurement& disc,
                         double sampling_variance_px2 = kSamplingVariance_px2) const {
    return measure_disc(bgr_, square_scale(kScale_px_per_m), radius_m_, start,
                        sampling_variance_px2, disc);
  }

 private:
  double radius_m_;
  Scene scene_;
  std::optional<Renderer> renderer_;
  cv::Mat bgr_;
};

PixelPoint random_place(RandomStream& random) {
  return {47.0 + random.uniform(), 47.0 + random.uniform()};
}

PixelPoint random_offset(RandomStream& random, double length_px) {
  const double angle_rad = random.uniform(0.0, 2.0 * M_PI);
  return length_px * PixelPoint(std::cos(angle_rad), std::sin(angle_rad));
}

struct ErrorSums {
  double squared_px2 = 0.0;  // per axis
  double variance_px2 = 0.0;
  PixelPoint bias_px = PixelPoint::Zero();
  double largest_px = 0.0;
  int count = 0;

  void add(const DiscMeasurement& disc, const PixelPoint& truth) {
    const PixelPoint error_px = disc.centre_px - truth;
    squared_px2 += 0.5 * error_px.squaredNorm();
    variance_px2 += disc.variance_px2;
    bias_px += error_px;
    largest_px = std::max(largest_px, error_px.cwiseAbs().maxCoeff());
    ++count;
  }
  double rms_px() const { return std::sqrt(squared_px2 / count); }
  /// Mean squared error over mean predicted variance.
  double honesty() const { return squared_px2 / variance_px2; }
};

class MeasuredDisc : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Radii, MeasuredDisc,
                         testing::Values(2.0, 2.5, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 13.0));

TEST_P(MeasuredDisc, CentreHoldsOverEverySubPixelPlace) {
  LoneDisc lone(GetParam());
  RandomStream random(1);
  ErrorSums errors;
  for (int v = 0; v < 10; ++v) {
    for (int u = 0; u < 10; ++u) {
      const PixelPoint truth(47.0 + 0.1 * u, 47.0 + 0.1 * v);
      lone.picture(truth);
      DiscMeasurement disc;
      ASSERT_EQ(lone.measure(truth + random_offset(random, 0.5), disc), MeasureOutcome::kMeasured);
      errors.add(disc, truth);
      EXPECT_NEAR(disc.pixels / disc.expected_pixels, 1.0, GetParam() < 4.0 ? 0.25 : 0.1);
    }
  }
  std::printf("radius %.1f px: RMS %.4f px, largest %.4f px, predicted %.4f px\n", GetParam(),
              errors.rms_px(), errors.largest_px, std::sqrt(errors.variance_px2 / errors.count));
  EXPECT_LT(errors.rms_px(), GetParam() < 3.0 ? 0.04 : 0.02);
  EXPECT_LT((errors.bias_px / errors.count).norm(), 0.005);
  EXPECT_LT(errors.honesty(), 2.0);
}

// The search promises a start at most one radius away.
TEST_P(MeasuredDisc, AStartUpToOneRadiusAwayLeadsToTheSameCentre) {
  LoneDisc lone(GetParam());
  RandomStream random(2);
  for (int i = 0; i < 200; ++i) {
    const PixelPoint truth = random_place(random);
    lone.picture(truth);
    DiscMeasurement disc;
    const PixelPoint start = truth + random_offset(random, random.uniform(0.0, GetParam()));
    EXPECT_EQ(lone.measure(start, disc), MeasureOutcome::kMeasured)
        << "start " << (start - truth).transpose();
    EXPECT_LT((disc.centre_px - truth).norm(), 0.12) << "start " << (start - truth).transpose();
  }
}

// A disc near the rim of its plate, with a bright floor beyond: the floor passes for a share in the
// disc on the straight line between the two colours, and would pull the centre towards it.
TEST(MeasuredDisc, AFloorBeyondTheRimDoesNotPullTheCentre) {
  for (const double radius_px : {2.1, 2.5, 3.5, 5.0}) {
    MarkerLayout layout = lone_disc_layout(radius_px / kScale_px_per_m, Colour::kYellow);
    layout.outer = {{{2.4 * layout.centre_radius_m, 0.0}, layout.centre_radius_m, Colour::kYellow}};
    layout.teams[0].centre_colour = Colour::kBlue;
    Scene scene = straight_scene(layout, kSize_px, kSize_px, kScale_px_per_m);
    scene.floor.colour = {0.46F, 0.44F, 0.40F};
    scene.bodies[0].radius_m = scene.bodies[0].front_m = 3.6 * layout.centre_radius_m;
    Renderer renderer(scene, 5);
    RandomStream random(5);
    double along_px = 0.0;
    constexpr int kPlaces = 60;
    cv::Mat bgr;
    for (int i = 0; i < kPlaces; ++i) {
      const double heading_rad = random.uniform(0.0, 2.0 * M_PI);
      const PixelPoint forward(std::cos(heading_rad), -std::sin(heading_rad));
      const PixelPoint place = random_place(random);
      const RobotPlacement robot = robot_at(renderer.camera(), layout, place, heading_rad);
      renderer.render_robots(0, {&robot, 1}, bgr);
      const PixelPoint truth = place + 2.4 * radius_px * forward;
      const Bgr plate(36.0F, 36.0F, 36.0F);
      DiscMeasurement disc;
      ASSERT_EQ(
          measure_disc(bgr, square_scale(kScale_px_per_m), layout.centre_radius_m,
                       truth + random_offset(random, 0.3), kSamplingVariance_px2, disc, &plate),
          MeasureOutcome::kMeasured);
      along_px += (disc.centre_px - truth).dot(forward) / kPlaces;
    }
    EXPECT_LT(std::abs(along_px), 0.07) << radius_px;
  }
}

// The error of many noisy pictures against the variance that each of them claims.
TEST_P(MeasuredDisc, VarianceIsThatOfTheErrorsAtEveryNoise) {
  for (const double full_well_electrons : {40000.0, 10000.0, 2000.0, 500.0}) {
    for (const double level : {1.0, 0.4}) {
      LoneDisc lone(GetParam());
      lone.scene().sensor.noise = true;
      lone.scene().sensor.full_well_electrons = full_well_electrons;
      lone.scene().light.level = level;
      RandomStream random(3);
      ErrorSums errors;
      for (int i = 0; i < 300; ++i) {
        const PixelPoint truth = random_place(random);
        lone.picture(truth, i);
        DiscMeasurement disc;
        ASSERT_EQ(lone.measure(truth + random_offset(random, 0.5), disc),
                  MeasureOutcome::kMeasured);
        errors.add(disc, truth);
      }
      std::printf("radius %.1f px, full well %5.0f, level %.1f: RMS %.4f px, %.2f of predicted\n",
                  GetParam(), full_well_electrons, level, errors.rms_px(), errors.honesty());
      EXPECT_LT(errors.honesty(), 2.0) << full_well_electrons << " " << level;
      EXPECT_GT(errors.honesty(), 0.5) << full_well_electrons << " " << level;
    }
  }
}

// A shadow's edge across the disc: half of it gets half the light.
TEST(DiscMeasurement, AHalfShadowMovesTheCentreLittleAndTheVarianceSaysSo) {
  for (const double radius_px : {4.0, 6.0, 8.0, 12.0}) {
    RandomStream random(4);
    ErrorSums errors;
    for (int i = 0; i < 100; ++i) {
      LoneDisc lone(radius_px);
      const PixelPoint truth = random_place(random);
      const PixelPoint edge = truth + random_offset(random, random.uniform(0.0, radius_px));
      lone.scene().light.shadow = SceneShadow{.u_px = edge.x(),
                                              .v_px = edge.y(),
                                              .angle_rad = random.uniform(0.0, 2.0 * M_PI),
                                              .factor = 0.5,
                                              .softness_px = 2.0};
      lone.picture(truth);
      DiscMeasurement disc;
      ASSERT_EQ(lone.measure(truth + random_offset(random, 0.5), disc), MeasureOutcome::kMeasured);
      errors.add(disc, truth);
    }
    std::printf("shadow, radius %.1f px: RMS %.4f px, largest %.4f px, %.2f of predicted\n",
                radius_px, errors.rms_px(), errors.largest_px, errors.honesty());
    EXPECT_LT(errors.rms_px(), 0.02 * radius_px) << radius_px;
    EXPECT_LT(errors.honesty(), 2.0) << radius_px;
    EXPECT_GT(errors.honesty(), 0.3) << radius_px;
  }
}

// A painted line just beside the plate's rim must not pull the disc.
TEST(DiscMeasurement, AWhiteLineBesideTheRimDoesNotPullTheCentre) {
  for (const double radius_px : {3.0, 5.0, 8.0}) {
    RandomStream random(5);
    for (const double gap_px : {1.5, 2.5, 4.0}) {
      LoneDisc lone(radius_px);
      lone.scene().bodies[0].radius_m = lone.scene().bodies[0].front_m =
          (radius_px + gap_px) / kScale_px_per_m;
      // The line's near edge: `gap_px` to the right of a disc in the middle, on the field's plane.
      const Scene& scene = lone.scene();
      const double floor_px_per_m = scene.camera.focal_px / scene.camera.height_m;
      const double half_width_m = 4.0 / kScale_px_per_m;
      const double line_x_m = (radius_px + gap_px) / floor_px_per_m + half_width_m;
      lone.scene().floor.lines = {{{line_x_m, -1.0}, {line_x_m, 1.0}, 2.0 * half_width_m}};
      for (int i = 0; i < 20; ++i) {
        const PixelPoint truth(47.5, 47.0 + random.uniform());
        lone.picture(truth);
        DiscMeasurement disc;
        ASSERT_EQ(lone.measure(truth + random_offset(random, 0.5), disc),
                  MeasureOutcome::kMeasured);
        EXPECT_LT((disc.centre_px - truth).norm(), 0.1)
            << "radius " << radius_px << ", gap " << gap_px << ", error "
            << (disc.centre_px - truth).transpose();
      }
    }
  }
}

TEST(DiscMeasurement, MosaicsErrorsAreCoveredByTheirOwnSamplingVariance) {
  for (const double radius_px : {2.0, 2.5, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 13.0}) {
    LoneDisc lone(radius_px);
    lone.scene().sensor.mosaic = SceneSensor::Mosaic::kRggb;
    RandomStream random(6);
    ErrorSums errors;
    for (int i = 0; i < 300; ++i) {
      const PixelPoint truth(47.0 + 2.0 * random.uniform(), 47.0 + 2.0 * random.uniform());
      lone.picture(truth);
      DiscMeasurement disc;
      ASSERT_EQ(
          lone.measure(truth + random_offset(random, 0.5), disc, kDemosaicedSamplingVariance_px2),
          MeasureOutcome::kMeasured);
      errors.add(disc, truth);
    }
    std::printf("mosaic, radius %.1f px: RMS %.4f px, %.2f of predicted\n", radius_px,
                errors.rms_px(), errors.honesty());
    EXPECT_LT(errors.honesty(), 2.5) << radius_px;  // beats between disc and mosaic
  }
}

TEST(DiscMeasurement, ADiscThatCrossesABorderIsOutsideTheImage) {
  LoneDisc lone(6.0);
  for (const PixelPoint& place : {PixelPoint(3.0, 50.0), PixelPoint(50.0, 3.0),
                                  PixelPoint(92.0, 50.0), PixelPoint(50.0, 92.0)}) {
    lone.picture(place);
    DiscMeasurement disc;
    EXPECT_EQ(lone.measure(place, disc), MeasureOutcome::kOutsideImage);
  }
}

TEST(DiscMeasurement, AFlatPlaceHasNoContrast) {
  DiscMeasurement disc;
  EXPECT_EQ(measure_disc(flat_picture(60, 60, {40, 90, 200}), square_scale(250.0), 0.02,
                         {30.0, 30.0}, kSamplingVariance_px2, disc),
            MeasureOutcome::kWeakContrast);
}

// From its tip a wedge draws the window on to where it is wider.
TEST(DiscMeasurement, AWedgeDrawsTheWindowAway) {
  cv::Mat bgr = flat_picture(120, 120, {20, 20, 20});
  for (int u = 40; u < 90; ++u) {
    const int half = (u - 40) / 3;
    bgr(cv::Rect(u, 60 - half, 1, 2 * half + 1)).setTo(cv::Scalar(230, 140, 30));
  }
  DiscMeasurement disc;
  EXPECT_EQ(measure_disc(bgr, square_scale(250.0), 0.02, {44.0, 60.0}, kSamplingVariance_px2, disc),
            MeasureOutcome::kDriftsAway);
}

}  // namespace
}  // namespace nadir::vision
