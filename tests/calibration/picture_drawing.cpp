#include "tests/calibration/picture_drawing.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace nadir::calibration {
namespace {

constexpr double kAround = 150.0;  // grey level of the field
constexpr double kBlack = 30.0;
constexpr double kWhite = 225.0;

using Cells = std::vector<std::vector<char>>;  // of a tag, 1 is white, row 0 at the top

Cells tag_cells(const apriltag_family_t& family, int id) {
  const int width = family.total_width;
  Cells cells(static_cast<std::size_t>(width), std::vector<char>(static_cast<std::size_t>(width)));
  const int border = (width - family.width_at_border) / 2;
  for (int i = 0; i < width; ++i) {
    for (int j = 0; j < width; ++j) {
      const bool outside = i < border || j < border || i >= width - border || j >= width - border;
      cells[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = outside ? 1 : 0;
    }
  }
  for (std::uint32_t bit = 0; bit < family.nbits; ++bit) {
    const bool white = ((family.codes[id] >> (family.nbits - 1 - bit)) & 1U) != 0;
    const auto row = static_cast<std::size_t>(static_cast<int>(family.bit_y[bit]) + border);
    const auto column = static_cast<std::size_t>(static_cast<int>(family.bit_x[bit]) + border);
    cells[row][column] = white ? 1 : 0;
  }
  return cells;
}

}  // namespace

cv::Mat drawn_picture(const cv::Size& size, const Truth& truth, const Shade& shade,
                      std::uint64_t seed, int rays) {
  cv::Mat picture(size, CV_32F);
  // A ray somewhere in each part of the pixel: on a regular grid all pixels along an edge would err
  // alike.
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      double sum = 0.0;
      for (int i = 0; i < rays; ++i) {
        for (int j = 0; j < rays; ++j) {
          const double du = (i + place(random)) / rays - 0.5;
          const double dv = (j + place(random)) / rays - 0.5;
          sum += shade(truth({u + du, v + dv}));
        }
      }
      picture.at<float>(v, u) = static_cast<float>(sum / (rays * rays));
    }
  }
  cv::GaussianBlur(picture, picture, {0, 0}, 0.7);
  std::normal_distribution<float> normal(0.0F, 3.0F);
  for (float& value : cv::Mat_<float>(picture)) value += normal(random);
  cv::Mat grey;
  picture.convertTo(grey, CV_8U);
  cv::Mat bgr;
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

Shade checkerboard(const Eigen::Vector2d& origin_m, double direction_rad, double square_m,
                   int columns, int rows) {
  const Eigen::Vector2d along(std::cos(direction_rad), std::sin(direction_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  return [=](const Eigen::Vector2d& place_m) {
    const double column = (place_m - origin_m).dot(along) / square_m;
    const double row = (place_m - origin_m).dot(across) / square_m;
    if (column < -1.0 || row < -1.0 || column > columns || row > rows) return kAround;
    const bool even =
        (static_cast<int>(std::floor(column)) + static_cast<int>(std::floor(row)) + 1000) % 2 == 0;
    return even ? kBlack : kWhite;
  };
}

Shade tags(const std::vector<DrawnTag>& placed, double side_m) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               tag36h11_destroy);
  const double cell_m = side_m / family->width_at_border;
  const int width = family->total_width;
  std::vector<Cells> cells;
  for (const DrawnTag& tag : placed) cells.push_back(tag_cells(*family, tag.id));
  return [=](const Eigen::Vector2d& place_m) {
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const Eigen::Vector2d from_middle = (place_m - placed[i].place_m) / cell_m;
      const int column = static_cast<int>(std::floor(from_middle.x() + 0.5 * width));
      const int row = static_cast<int>(std::floor(0.5 * width - from_middle.y()));
      if (column < 0 || row < 0 || column >= width || row >= width) continue;
      return cells[i][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] != 0
                 ? kWhite
                 : kBlack;
    }
    return kAround;
  };
}

vision::PixelPoint pixel_of(const Truth& truth, const Eigen::Vector2d& place_m,
                            const vision::PixelPoint& start) {
  constexpr double kStep_px = 1e-3;
  vision::PixelPoint pixel = start;
  for (int i = 0; i < 30; ++i) {
    Eigen::Matrix2d jacobian;
    jacobian.col(0) = (truth(pixel + Eigen::Vector2d(kStep_px, 0)) -
                       truth(pixel - Eigen::Vector2d(kStep_px, 0))) /
                      (2 * kStep_px);
    jacobian.col(1) = (truth(pixel + Eigen::Vector2d(0, kStep_px)) -
                       truth(pixel - Eigen::Vector2d(0, kStep_px))) /
                      (2 * kStep_px);
    pixel += jacobian.inverse() * (place_m - truth(pixel));
  }
  return pixel;
}

void write_png(const std::string& file, const cv::Mat& picture) {
  if (!cv::imwrite(file, picture)) throw std::runtime_error(file + " cannot be written");
}

}  // namespace nadir::calibration
