// Tags aligned with rendered frames.

#include "tracker/alignment/tag_aligner.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/tracker/tag_scenes.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::tracker {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Study : TagErrors {
  double blur_px = 0.0;
  double iterations = 0.0;
};

// Tags aligned from guesses that are `guess_px` off.
Study study(double side_px, TagLight light, int frames, double guess_px) {
  TagCamera camera = tag_camera(side_px, light, 7);
  const PlaneGrid grid(camera.map, camera.renderer.camera().width_px(),
                       camera.renderer.camera().height_px());
  TagAligner aligner(*camera.layout.tags, grid);
  SensorModel sensor(camera.renderer.camera().width_px(), camera.renderer.camera().height_px());
  const Mosaic mosaic = light == TagLight::kEven ? Mosaic::kNone : Mosaic::kRggb;
  vision::RandomStream random(3, 0, 99);
  Study result;
  double places = 0.0;
  double headings = 0.0;
  const double m_per_px = camera.layout.tags->size_m / side_px;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    const vision::Frame frame = frame_of(camera.renderer, number);
    for (const vision::RobotTruth& truth : camera.renderer.truth(number)) {
      fusion::PlanarPose guess{truth.x_m + guess_px * m_per_px * random.normal(),
                               truth.y_m + guess_px * m_per_px * random.normal(),
                               truth.heading_rad + guess_px / side_px * random.normal()};
      AlignedTag aligned;
      const bool found = aligner.align(frame.image, mosaic, sensor, truth.id, guess,
                                       {truth.u_px, truth.v_px}, aligned);
      if (found) aligner.teach(sensor);
      if (k < 3) continue;  // blur and noise are learnt
      ++result.shown;
      if (!found) continue;
      ++result.found;
      const fusion::PlanarPose& pose = aligned.pose_world_tag;
      const Eigen::Vector3d error(pose.x_m - truth.x_m, pose.y_m - truth.y_m,
                                  fusion::wrap_angle(pose.heading_rad - truth.heading_rad));
      places += 0.5 * error.head<2>().squaredNorm() / (m_per_px * m_per_px);
      headings += error.z() * error.z();
      result.nees += error.dot(aligned.covariance.inverse() * error);
      result.iterations += aligned.iterations;
    }
  }
  result.place_px = std::sqrt(places / result.found);
  result.heading_deg = kDegrees * std::sqrt(headings / result.found);
  result.nees /= result.found;
  result.iterations /= result.found;
  result.blur_px = sensor.blur_px();
  return result;
}

TEST(TagAligner, ErrorsAreAsLargeAsTheirCovariancesSay) {
  for (const TagLight light : {TagLight::kEven, TagLight::kBayer, TagLight::kDim}) {
    for (const double side_px : {18.0, 42.0}) {
      const Study errors = study(side_px, light, side_px < 50.0 ? 15 : 23, 0.2);
      const std::string name = std::to_string(static_cast<int>(light)) + ", " +
                               std::to_string(side_px) + " px: " + std::to_string(errors.place_px) +
                               " px, " + std::to_string(errors.heading_deg) + " deg";
      EXPECT_EQ(errors.found, errors.shown) << name;
      EXPECT_GT(errors.nees, side_px < 24.0 ? 1.3 : 2.0) << name;
      EXPECT_LT(errors.nees, 3.8) << name;
      // The optics' 0.7 px and a pixel's own square.
      EXPECT_NEAR(errors.blur_px, std::sqrt(0.49 + 1.0 / 12.0), 0.01) << name;
    }
  }
}

}  // namespace
}  // namespace nadir::tracker
