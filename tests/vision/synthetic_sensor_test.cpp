#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "tests/vision/synthetic_test_scenes.h"
#include "vision/synthetic/image_sensor.h"
#include "vision/synthetic/renderer.h"

namespace nadir::vision {
namespace {

constexpr int kWidth = 640;
constexpr int kRows = 400;

/// An evenly lit picture of one grey level, blue channel only.
std::vector<double> even_picture(const SceneSensor& parameters, float grey, std::uint64_t frame) {
  ImageSensor sensor(parameters);
  RandomStream random(3, frame, 9);
  const std::vector<float> light(3 * kWidth, grey);
  std::vector<std::uint8_t> samples(3 * kWidth);
  std::vector<double> blue;
  for (int row = 0; row < kRows; ++row) {
    sensor.expose_row(light.data(), kWidth, row, random, samples.data());
    for (int u = 0; u < kWidth; ++u) blue.push_back(samples[3 * u]);
  }
  return blue;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Covariance of a picture with another, or with itself `shift` samples on.
double covariance(const std::vector<double>& a, const std::vector<double>& b, std::size_t shift) {
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double sum = 0.0;
  for (std::size_t i = 0; i + shift < a.size(); ++i)
    sum += (a[i] - mean_a) * (b[i + shift] - mean_b);
  return sum / static_cast<double>(a.size() - shift);
}

TEST(ImageSensor, NoiseHasTheVarianceOfTheDeclaredElectrons) {
  SceneSensor sensor;
  sensor.full_well_electrons = 8000.0;
  sensor.read_noise_electrons = 30.0;
  const double grey_per_electron = 255.0 / 8000.0;
  for (const float grey : {20.0F, 60.3F, 120.0F, 200.7F}) {
    const std::vector<double> picture = even_picture(sensor, grey, 0);
    const double electrons = grey / grey_per_electron;
    // Poisson: as much variance as electrons; rounding to whole grey levels adds 1/12.
    const double expected =
        (electrons + 30.0 * 30.0) * grey_per_electron * grey_per_electron + 1.0 / 12.0;
    EXPECT_NEAR(covariance(picture, picture, 0) / expected, 1.0, 0.015) << grey;
    EXPECT_NEAR(mean_of(picture), grey, 0.02) << grey;
  }
}

TEST(ImageSensor, NoiseIsIndependentFromPixelToPixelAndFrameToFrame) {
  const SceneSensor sensor;
  const std::vector<double> picture = even_picture(sensor, 120.0F, 0);
  const std::vector<double> next = even_picture(sensor, 120.0F, 1);
  const double variance = covariance(picture, picture, 0);
  for (const std::size_t shift : {1, 2, 43, 128, kWidth}) {
    EXPECT_LT(std::abs(covariance(picture, picture, shift)) / variance, 0.012) << shift;
  }
  EXPECT_LT(std::abs(covariance(picture, next, 0)) / variance, 0.012);
}

TEST(ImageSensor, SaturatesAtFullWellAndNeverWraps) {
  const SceneSensor sensor;
  for (const double value : even_picture(sensor, 400.0F, 0)) ASSERT_EQ(value, 255.0);
  double lowest = 255.0;
  double highest = 0.0;
  for (const double value : even_picture(sensor, 0.2F, 0)) {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  EXPECT_EQ(lowest, 0.0);
  EXPECT_LT(highest, 6.0);
}

TEST(ImageSensor, GammaIsAppliedBeforeTheBits) {
  SceneSensor parameters;
  parameters.noise = false;
  parameters.gamma = 2.2;
  for (const float grey : {1.0F, 10.0F, 100.0F, 255.0F}) {
    const double expected = 255.0 * std::pow(grey / 255.0, 1.0 / 2.2);
    EXPECT_NEAR(even_picture(parameters, grey, 0)[0], expected, 0.51) << grey;
  }
}

class Mosaic : public testing::TestWithParam<SceneSensor::Mosaic> {};

TEST_P(Mosaic, KeepsNativeSamplesAndAveragesTheNearestOthers) {
  SceneSensor parameters;
  parameters.mosaic = GetParam();
  const ImageSensor sensor(parameters);
  cv::Mat samples(30, 42, CV_8UC1);
  RandomStream random(5);
  for (int v = 0; v < samples.rows; ++v) {
    for (int u = 0; u < samples.cols; ++u) {
      samples.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(random.below(256));
    }
  }
  cv::Mat bgr;
  sensor.demosaic(samples, bgr);
  for (int v = 0; v < samples.rows; ++v) {
    for (int u = 0; u < samples.cols; ++u) {
      const cv::Vec3b pixel = bgr.at<cv::Vec3b>(v, u);
      const int native = sensor.native_channel(u, v);
      ASSERT_EQ(pixel[native], samples.at<std::uint8_t>(v, u)) << u << ", " << v;
      // Bilinear: the neighbours of a channel that are nearest to the pixel, evenly weighted.
      for (int c = 0; c < 3; ++c) {
        double sum[3] = {0, 0, 0};
        int count[3] = {0, 0, 0};
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) {
            const int x = u + du;
            const int y = v + dv;
            if (x < 0 || y < 0 || x >= samples.cols || y >= samples.rows) continue;
            if (sensor.native_channel(x, y) != c) continue;
            const int distance = du * du + dv * dv;
            sum[distance] += samples.at<std::uint8_t>(y, x);
            ++count[distance];
          }
        }
        const int nearest = count[0] > 0 ? 0 : (count[1] > 0 ? 1 : 2);
        if (count[nearest] == 0) continue;
        ASSERT_NEAR(pixel[c], sum[nearest] / count[nearest], 0.51) << u << ", " << v << ", " << c;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllPhases, Mosaic,
                         testing::Values(SceneSensor::Mosaic::kRggb, SceneSensor::Mosaic::kBggr,
                                         SceneSensor::Mosaic::kGrbg, SceneSensor::Mosaic::kGbrg));

TEST(ImageSensor, MosaicFrameHasTheFullColourFramesNativeSamples) {
  const MarkerLayout layout = lone_disc_layout(0.03, Colour::kPink);
  Scene scene = plain_scene(layout);
  scene.robots.push_back({0, 0, 0, {}});
  cv::Mat full;
  cv::Mat mosaic;
  Renderer(scene, 1).render(0, full);
  scene.sensor.mosaic = SceneSensor::Mosaic::kGrbg;
  Renderer(scene, 1).render(0, mosaic);
  const ImageSensor sensor(scene.sensor);
  for (int v = 0; v < full.rows; ++v) {
    for (int u = 0; u < full.cols; ++u) {
      const int native = sensor.native_channel(u, v);
      ASSERT_EQ(mosaic.at<cv::Vec3b>(v, u)[native], full.at<cv::Vec3b>(v, u)[native]);
    }
  }
}

}  // namespace
}  // namespace nadir::vision
