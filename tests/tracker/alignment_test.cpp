// Poses straight from the pixels: the model of a blurred disc, the plane's grid, the mosaic, and
// what comes out of them.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tests/tracker/synthetic_setup.h"
#include "tracker/alignment/disc_shares.h"
#include "tracker/alignment/pose_aligner.h"
#include "tracker/alignment/sensor_lesson.h"

namespace nadir::tracker {
namespace {

constexpr double kScale_m = 0.004;  // metres per pixel

// A patch of 24 x 24 pixels about the origin.
std::unique_ptr<DiscPatch> square_patch() {
  auto patch = std::make_unique<DiscPatch>();
  patch->plane.slope = kScale_m * Eigen::Matrix2d::Identity();
  for (int v = -12; v < 12; ++v) {
    for (int u = -12; u < 12; ++u) {
      const auto i = static_cast<std::size_t>(patch->count++);
      patch->du[i] = static_cast<float>(u);
      patch->dv[i] = static_cast<float>(v);
      patch->use[i] = 1.0F;
    }
  }
  patch->begin = {0, 0, 0};
  patch->end = {patch->count, patch->count, patch->count};
  return patch;
}

// The exact share: the disc's chord seen through a Gaussian, integrated along one axis.
double exact_share(double distance_px, double radius_px, double blur_px) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double y = (k + 0.5) / kSteps * 12.0 - 6.0;
    const double across = blur_px * y;
    if (std::abs(across) >= radius_px) continue;
    const double half = std::sqrt(radius_px * radius_px - across * across);
    const auto below = [&](double x) { return 0.5 * std::erfc(-x / (blur_px * M_SQRT2)); };
    sum += std::exp(-0.5 * y * y) * (below(half - distance_px) - below(-half - distance_px));
  }
  return sum * 12.0 / kSteps / std::sqrt(2.0 * M_PI);
}

TEST(DiscShares, AreTheConvolutionOfADiscWithAGaussian) {
  const auto patch = square_patch();
  const auto shares = std::make_unique<DiscShares>();
  for (const double radius_px : {2.5, 4.3, 7.0}) {
    const DiscEdge edge{radius_px * kScale_m, 0.76};
    const Eigen::Vector2d centre_m(0.3 * kScale_m, -0.2 * kScale_m);
    find_shares(*patch, edge, centre_m, *shares);
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch->count); i += 7) {
      const double distance_px = std::hypot(static_cast<double>(patch->du[i]) - 0.3,
                                            static_cast<double>(patch->dv[i]) + 0.2);
      EXPECT_NEAR(static_cast<double>(shares->share[i]),
                  exact_share(distance_px, radius_px, edge.blur_px), radius_px < 3.0 ? 4e-3 : 1e-3)
          << "radius " << radius_px << ", distance " << distance_px;
    }
  }
}

TEST(DiscShares, DerivativesAreThoseOfDifferences) {
  const auto patch = square_patch();
  const auto here = std::make_unique<DiscShares>();
  const auto after = std::make_unique<DiscShares>();
  const auto before = std::make_unique<DiscShares>();
  const DiscEdge edge{5.0 * kScale_m, 0.8};
  const Eigen::Vector2d centre_m(0.4 * kScale_m, 0.1 * kScale_m);
  find_shares_and_blur(*patch, edge, centre_m, *here);
  const double step_m = 0.02 * kScale_m;
  const auto largest_error = [&](const auto& derivative, double step) {
    double largest = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch->count); ++i) {
      const double difference = static_cast<double>(after->share[i] - before->share[i]);
      largest =
          std::max(largest, std::abs(difference - 2.0 * step * static_cast<double>(derivative[i])));
    }
    return largest;
  };
  find_shares(*patch, edge, centre_m + Eigen::Vector2d(step_m, 0.0), *after);
  find_shares(*patch, edge, centre_m - Eigen::Vector2d(step_m, 0.0), *before);
  EXPECT_LT(largest_error(here->by_x, step_m), 5e-5);
  find_shares(*patch, edge, centre_m + Eigen::Vector2d(0.0, step_m), *after);
  find_shares(*patch, edge, centre_m - Eigen::Vector2d(0.0, step_m), *before);
  EXPECT_LT(largest_error(here->by_y, step_m), 5e-5);
  find_shares(*patch, {edge.radius_m, edge.blur_px + 0.02}, centre_m, *after);
  find_shares(*patch, {edge.radius_m, edge.blur_px - 0.02}, centre_m, *before);
  EXPECT_LT(largest_error(here->by_blur, 0.02), 3e-4);  // to first order of the curvature
}

TEST(PlaneGrid, IsTheMapAndItsInverse) {
  const SyntheticCamera camera = synthetic_camera("pair_even", 1);
  const calibration::PlaneMap& map = camera.setup.calibration.map;
  const PlaneGrid grid(map, 640, 480);
  for (const vision::PixelPoint& pixel :
       {vision::PixelPoint(3.2, 5.1), {320.4, 240.9}, {635.7, 471.3}}) {
    const Eigen::Vector2d place_m = grid.plane_from_pixel(pixel);
    EXPECT_LT((place_m - map.plane_from_pixel(pixel)).norm(), 1e-9);
    const auto back = grid.pixel_near(place_m, {300.0, 200.0});
    ASSERT_TRUE(back.has_value());
    EXPECT_LT((*back - pixel).norm(), 1e-6);
  }
}

TEST(RecogniseMosaic, TellsTheFourPhasesAndNone) {
  using Sensor = vision::SceneSensor::Mosaic;
  const SyntheticCamera camera = synthetic_camera("league_even", 1);
  for (const auto& [sensor, mosaic] : {std::pair(Sensor::kNone, Mosaic::kNone),
                                       {Sensor::kRggb, Mosaic::kRggb},
                                       {Sensor::kBggr, Mosaic::kBggr},
                                       {Sensor::kGrbg, Mosaic::kGrbg},
                                       {Sensor::kGbrg, Mosaic::kGbrg}}) {
    vision::Scene scene = camera.renderer.scene();
    scene.sensor.mosaic = sensor;
    vision::Renderer renderer(scene, 1);
    EXPECT_EQ(recognise_mosaic(rendered_frame(renderer, 0).image), mosaic);
  }
}

// A league robot in a rendered frame, with aligner and guess.
class LeagueRobot : public testing::Test {
 protected:
  LeagueRobot()
      : camera_(synthetic_camera("league_even", 4)),
        map_(camera_.setup.calibration.map),
        grid_(map_, 1280, 1024),
        aligner_(camera_.setup.layouts[0], grid_),
        sensor_(1280, 1024),
        image_(rendered_frame(camera_.renderer, 0).image),
        truth_(camera_.renderer.truth(0)[0]) {}

  PoseGuess guess(double x_px, double y_px, double turn_rad) const {
    const double m = grid_.metres_per_pixel({truth_.u_px, truth_.v_px});
    return {{truth_.x_m + x_px * m, truth_.y_m + y_px * m,
             fusion::wrap_angle(truth_.heading_rad + turn_rad)},
            {truth_.u_px, truth_.v_px}};
  }
  bool align(const PoseGuess& from, const ExpectedLook* look, AlignedPose& result) {
    return aligner_.align(image_, Mosaic::kNone, sensor_, from, look, {}, result);
  }
  ExpectedLook look() {
    AlignedPose aligned;
    EXPECT_TRUE(align(guess(0, 0, 0), nullptr, aligned));
    ExpectedLook seen;
    for (std::size_t i = 0; i < 5; ++i) seen.contrast[i] = aligned.discs[i].contrast;
    return seen;
  }
  void cover(int disc, const cv::Scalar& colour) {
    const Eigen::Vector2d& p = aligner_.robot().place_m[static_cast<std::size_t>(disc)];
    const double c = std::cos(truth_.heading_rad);
    const double s = std::sin(truth_.heading_rad);
    const auto at =
        grid_.pixel_near({truth_.x_m + c * p.x() - s * p.y(), truth_.y_m + s * p.x() + c * p.y()},
                         {truth_.u_px, truth_.v_px});
    cv::circle(image_,
               {static_cast<int>(std::lround(at->x())), static_cast<int>(std::lround(at->y()))}, 7,
               colour, cv::FILLED);
  }

  SyntheticCamera camera_;
  calibration::PlaneMap map_;
  PlaneGrid grid_;
  PoseAligner aligner_;
  SensorModel sensor_;
  cv::Mat image_;
  vision::RobotTruth truth_;
};

TEST_F(LeagueRobot, IsFoundTheSameFromAllGuessesWithinThreePixels) {
  AlignedPose first;
  ASSERT_TRUE(align(guess(0.0, 0.0, 0.0), nullptr, first));
  EXPECT_NEAR(first.centre_px.x(), truth_.u_px, 0.02);
  EXPECT_NEAR(first.centre_px.y(), truth_.v_px, 0.02);
  for (const auto& [x_px, y_px, turn_rad] :
       {std::tuple(1.0, -0.5, 0.05), {-2.0, 1.0, -0.1}, {2.0, 2.0, 0.15}}) {
    AlignedPose other;
    ASSERT_TRUE(align(guess(x_px, y_px, turn_rad), nullptr, other));
    EXPECT_LT((other.centre_px - first.centre_px).norm(), 0.003);
  }
}

TEST_F(LeagueRobot, GoesOnWithOneCoveredDiscAndIsLostWithTwo) {
  const ExpectedLook expected = look();
  AlignedPose whole;
  ASSERT_TRUE(align(guess(0.2, 0.1, 0.0), &expected, whole));
  EXPECT_EQ(whole.counting_discs, 5);
  cover(2, {25, 125, 235});
  AlignedPose covered;
  ASSERT_TRUE(align(guess(0.2, 0.1, 0.0), &expected, covered));
  EXPECT_EQ(covered.counting_discs, 4);
  EXPECT_FALSE(covered.discs[2].counts);
  EXPECT_LT((covered.centre_px - whole.centre_px).norm(), 0.02);
  cover(4, {40, 40, 40});
  AlignedPose lost;
  EXPECT_FALSE(align(guess(0.2, 0.1, 0.0), &expected, lost));
}

TEST_F(LeagueRobot, IsNobodyElse) {
  ExpectedLook other = look();
  std::swap(other.contrast[0], other.contrast[1]);
  AlignedPose result;
  EXPECT_FALSE(align(guess(0.0, 0.0, 0.0), &other, result));
  PoseGuess nowhere = guess(0.0, 0.0, 0.0);
  nowhere.pose_world_robot.x_m += 50.0;
  EXPECT_FALSE(align(nowhere, nullptr, result));
}

// However many robots there are, of whatever number of discs, and however many share a lesson.
TEST(SensorLesson, EveryDiscOfEveryRobotTeaches) {
  for (const unsigned robots_per_lesson : {1U, 4U}) {
    for (const unsigned discs : {2U, 4U, 5U}) {
      for (unsigned robots = 1; robots <= 4 * discs; ++robots) {
        std::vector<int> lessons(robots * discs);
        const unsigned frames = 10 * discs * robots_per_lesson;
        for (unsigned frame = 0; frame < frames; ++frame) {
          for (unsigned robot = 0; robot < robots; ++robot) {
            const auto lesson = lesson_due(frame, robot, robots_per_lesson);
            if (lesson) ++lessons[robot * discs + *lesson % discs];
          }
        }
        for (const int of_a_disc : lessons) ASSERT_EQ(of_a_disc, 10) << robots << " robots";
      }
    }
  }
}

// NEES over robots of some frames; blur and noise are learnt on the way.
TEST(PoseAligner, CovarianceHolds) {
  SyntheticCamera camera = synthetic_camera("pair_even", 6);
  const PlaneGrid grid(camera.setup.calibration.map, 640, 480);
  PoseAligner aligner(camera.setup.layouts[0], grid);
  SensorModel sensor(640, 480);
  double nees = 0.0;
  int count = 0;
  unsigned lesson = 0;
  for (std::uint64_t frame = 0; frame < 60; ++frame) {
    const cv::Mat image = rendered_frame(camera.renderer, frame).image;
    for (const vision::RobotTruth& truth : camera.renderer.truth(frame)) {
      AlignedPose aligned;
      const fusion::PlanarPose pose{truth.x_m, truth.y_m, truth.heading_rad};
      ASSERT_TRUE(aligner.align(image, Mosaic::kNone, sensor, {pose, {truth.u_px, truth.v_px}},
                                nullptr, {}, aligned));
      aligner.teach(image, Mosaic::kNone, lesson++, sensor);
      if (frame < 10) continue;
      const Eigen::Vector3d error = fusion::pose_difference(aligned.pose_world_robot, pose);
      Eigen::Matrix3d covariance = aligned.covariance;
      covariance.topLeftCorner<2, 2>() +=
          camera.setup.calibration.map.calibration_covariance_m2(aligned.centre_px);
      nees += error.dot(covariance.ldlt().solve(error));
      ++count;
    }
  }
  // 150 robots: 3 with a standard deviation of 0.2 if all is right, more where the pattern is
  // small.
  EXPECT_GT(nees / count, 2.0);
  EXPECT_LT(nees / count, 4.0);
  EXPECT_NEAR(sensor.blur_px(), std::hypot(0.7, std::sqrt(1.0 / 12.0)), 0.02);
  EXPECT_NEAR(sensor.noise().shot, 255.0 / 10000.0, 0.005);
}

}  // namespace
}  // namespace nadir::tracker
