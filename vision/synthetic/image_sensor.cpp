#include "vision/synthetic/image_sensor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/vector_clones.h"

namespace nadir::vision {
namespace {

constexpr int kTableSize = 1 << 18;
constexpr int kRun = 128;
constexpr float kHalf = 0.5F;  // added before a cast it rounds, and vectorises as lround does not
constexpr std::uint64_t kTableSeed = 20100419;

/// Standard normal numbers of exactly zero mean and unit variance.
const std::vector<float>& normal_table() {
  static const std::vector<float> numbers = [] {
    std::vector<float> table(kTableSize);
    RandomStream random(kTableSeed);
    double sum = 0.0;
    double squares = 0.0;
    for (float& value : table) {
      value = static_cast<float>(random.normal());
      sum += value;
      squares += static_cast<double>(value) * value;
    }
    const double mean = sum / kTableSize;
    const double scale = 1.0 / std::sqrt(squares / kTableSize - mean * mean);
    for (float& value : table) value = static_cast<float>((value - mean) * scale);
    return table;
  }();
  return numbers;
}

std::array<int, 4> channels_of(SceneSensor::Mosaic mosaic) {
  switch (mosaic) {
    case SceneSensor::Mosaic::kRggb:
      return {2, 1, 1, 0};
    case SceneSensor::Mosaic::kBggr:
      return {0, 1, 1, 2};
    case SceneSensor::Mosaic::kGrbg:
      return {1, 2, 0, 1};
    case SceneSensor::Mosaic::kGbrg:
      return {1, 0, 2, 1};
    case SceneSensor::Mosaic::kNone:
      break;
  }
  return {0, 0, 0, 0};
}

/// OpenCV names a mosaic by the second and third pixel of its second row.
int opencv_code(SceneSensor::Mosaic mosaic) {
  switch (mosaic) {
    case SceneSensor::Mosaic::kRggb:
      return cv::COLOR_BayerBG2BGR;
    case SceneSensor::Mosaic::kBggr:
      return cv::COLOR_BayerRG2BGR;
    case SceneSensor::Mosaic::kGrbg:
      return cv::COLOR_BayerGB2BGR;
    default:
      return cv::COLOR_BayerGR2BGR;
  }
}

}  // namespace

ImageSensor::ImageSensor(const SceneSensor& sensor)
    : sensor_(sensor), pattern_(channels_of(sensor.mosaic)) {
  if (sensor.gamma != 1.0) {
    gamma_table_.resize(65536);
    for (int i = 0; i < 65536; ++i) {
      const double grey = 255.0 * std::pow(i / 65535.0, 1.0 / sensor.gamma);
      gamma_table_[i] = static_cast<std::uint8_t>(std::lround(grey));
    }
  }
}

void ImageSensor::expose_row(const float* light, int width, int row, RandomStream& random,
                             std::uint8_t* samples) {
  const int count = has_mosaic() ? width : 3 * width;
  row_.resize(count);
  if (has_mosaic()) {
    const int even = native_channel(0, row);
    const int odd = native_channel(1, row);
    for (int u = 0; u < width; ++u) row_[u] = light[3 * u + ((u & 1) != 0 ? odd : even)];
  } else {
    std::copy(light, light + count, row_.begin());
  }
  if (sensor_.noise) add_noise(count, random);
  quantise(count, samples);
}

/// Variance in grey levels: each electron is `grey` levels, shot noise has as many electrons
/// variance as charge. A noise number is the sum of two runs of the table at random places: nothing
/// repeats visibly.
void ImageSensor::add_noise(int count, RandomStream& random) {
  const float* table = normal_table().data();
  const auto grey = static_cast<float>(255.0 / sensor_.full_well_electrons);
  const auto read_grey = static_cast<float>(sensor_.read_noise_electrons) * grey;
  const float half_shot = 0.5F * grey;
  const float half_read = 0.5F * read_grey * read_grey;
  for (int begin = 0; begin < count; begin += kRun) {
    const std::uint64_t draw = random.next();
    const float* first = table + (draw & 0xFFFFFFFF) % (kTableSize - kRun);
    const float* second = table + (draw >> 32) % (kTableSize - kRun);
    float* out = row_.data() + begin;
    const int run = std::min(kRun, count - begin);
    for (int i = 0; i < run; ++i) {
      const float charge = out[i] > 0.0F ? out[i] : 0.0F;
      out[i] += std::sqrt(half_shot * charge + half_read) * (first[i] + second[i]);
    }
  }
}

NADIR_VECTOR_CLONES
void ImageSensor::quantise(int count, std::uint8_t* samples) const {
  if (gamma_table_.empty()) {
    for (int i = 0; i < count; ++i) {
      const float low = row_[i] > 0.0F ? row_[i] : 0.0F;
      const float grey = low < 255.0F ? low : 255.0F;
      samples[i] = static_cast<std::uint8_t>(static_cast<int>(grey + kHalf));
    }
    return;
  }
  for (int i = 0; i < count; ++i) {
    const float grey = std::clamp(row_[i], 0.0F, 255.0F);
    samples[i] = gamma_table_[static_cast<int>(grey * 257.0F + kHalf)];
  }
}

void ImageSensor::demosaic(const cv::Mat& samples, cv::Mat& bgr) const {
  cv::cvtColor(samples, bgr, opencv_code(sensor_.mosaic));
  // cvtColor copies its neighbours into the outermost pixels: average what there is of each channel
  // instead.
  const auto repair = [&](int u, int v) {
    int sum[3] = {0, 0, 0};
    int count[3] = {0, 0, 0};
    for (int y = std::max(0, v - 1); y <= std::min(samples.rows - 1, v + 1); ++y) {
      for (int x = std::max(0, u - 1); x <= std::min(samples.cols - 1, u + 1); ++x) {
        const int channel = native_channel(x, y);
        sum[channel] += samples.at<std::uint8_t>(y, x);
        ++count[channel];
      }
    }
    cv::Vec3b& pixel = bgr.at<cv::Vec3b>(v, u);
    for (int c = 0; c < 3; ++c) {
      if (count[c] > 0) pixel[c] = static_cast<std::uint8_t>((sum[c] + count[c] / 2) / count[c]);
    }
    pixel[native_channel(u, v)] = samples.at<std::uint8_t>(v, u);
  };
  for (int u = 0; u < samples.cols; ++u) {
    repair(u, 0);
    repair(u, samples.rows - 1);
  }
  for (int v = 0; v < samples.rows; ++v) {
    repair(0, v);
    repair(samples.cols - 1, v);
  }
}

}  // namespace nadir::vision
