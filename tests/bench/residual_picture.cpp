#include "tests/bench/residual_picture.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "tracker/alignment/disc_shares.h"
#include "tracker/alignment/pose_aligner.h"

namespace nadir::bench {
namespace {

using tracker::AlignedDisc;
using tracker::AlignedPose;

constexpr int kLessons = 20;
constexpr int kEnlargement = 5;
constexpr double kMargin = 1.15;      // of a robot's reach, to the edge of its crop
constexpr double kDiscMargin_px = 2;  // of the plate around a disc that the template is drawn on

struct Sum {
  double values = 0.0;
  double squares = 0.0;
  double count = 0.0;
  void add(double value) {
    values += value;
    squares += value * value;
    count += 1.0;
  }
  double mean() const { return count > 0.0 ? values / count : 0.0; }
  double rms() const { return count > 0.0 ? std::sqrt(squares / count) : 0.0; }
};

struct Workshop {
  const tracker::PlaneGrid& grid;
  tracker::PoseAligner aligner;
  tracker::SensorModel sensor;
  Sum left, marks, plates;
};

// The robots as often as it takes to learn the camera; poses of the last time.
std::vector<AlignedPose> align_all(const cv::Mat& bgr, std::span<const tracker::RobotReport> robots,
                                   Workshop& workshop) {
  std::vector<AlignedPose> poses;
  for (int lesson = 0; lesson < kLessons; ++lesson) {
    poses.clear();
    for (const tracker::RobotReport& robot : robots) {
      AlignedPose pose;
      if (!workshop.aligner.align(bgr, tracker::Mosaic::kNone, workshop.sensor,
                                  {robot.pose_world_robot, robot.centre_px}, nullptr, {}, pose))
        continue;
      workshop.aligner.teach(bgr, tracker::Mosaic::kNone, static_cast<unsigned>(lesson),
                             workshop.sensor);
      poses.push_back(pose);
    }
  }
  return poses;
}

// Draws one disc's template where its pixels are and its residual beside it.
void draw_disc(const cv::Mat& bgr, double radius_m, const AlignedDisc& disc, Workshop& workshop,
               cv::Mat& drawn, cv::Mat& residual) {
  auto patch = std::make_unique<tracker::DiscPatch>();
  auto shares = std::make_unique<tracker::DiscShares>();
  const Eigen::Vector2d centre_m = workshop.grid.plane_from_pixel(disc.centre_px);
  if (!tracker::gather(bgr, tracker::Mosaic::kNone, workshop.grid,
                       {.centre_m = centre_m,
                        .centre_px = disc.centre_px,
                        .radius_m = radius_m,
                        .margin_px = kDiscMargin_px,
                        .whole = true},
                       *patch))
    return;
  tracker::find_shares(*patch, {radius_m, workshop.sensor.blur_px()}, centre_m, *shares);
  for (int i = 0; i < patch->count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (patch->use[k] == 0.0F) continue;
    const int u = static_cast<int>(std::lround(patch->origin_px.x() + patch->du[k]));
    const int v = static_cast<int>(std::lround(patch->origin_px.y() + patch->dv[k]));
    for (int c = 0; c < 3; ++c) {
      const double model = disc.level[c] + disc.contrast[c] * shares->share[k];
      const double left = bgr.at<cv::Vec3b>(v, u)[c] - model;
      drawn.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<unsigned char>(model);
      residual.at<cv::Vec3b>(v, u)[c] =
          cv::saturate_cast<unsigned char>(128.0 + kResidualGain * left);
      workshop.left.add(left);
    }
  }
  for (int c = 0; c < 3; ++c) {
    workshop.marks.add(disc.contrast[c]);
    workshop.plates.add(disc.level[c]);
  }
}

cv::Rect crop_of(const AlignedPose& pose, double reach_px, const cv::Size& size) {
  const int half = static_cast<int>(std::ceil(reach_px));
  const cv::Point middle(static_cast<int>(std::lround(pose.centre_px.x())),
                         static_cast<int>(std::lround(pose.centre_px.y())));
  const int left = std::clamp(middle.x - half, 0, size.width - 2 * half - 1);
  const int top = std::clamp(middle.y - half, 0, size.height - 2 * half - 1);
  return {left, top, 2 * half + 1, 2 * half + 1};
}

cv::Mat enlarged(const cv::Mat& part) {
  cv::Mat result;
  cv::resize(part, result, {}, kEnlargement, kEnlargement, cv::INTER_NEAREST);
  cv::copyMakeBorder(result, result, 2, 2, 2, 2, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  return result;
}

// Columns of different heights next to each other.
cv::Mat side_by_side(std::vector<cv::Mat> columns) {
  int height = 0;
  for (const cv::Mat& column : columns) height = std::max(height, column.rows);
  for (cv::Mat& column : columns) {
    cv::copyMakeBorder(column, column, 0, height - column.rows, 0, 0, cv::BORDER_CONSTANT,
                       cv::Scalar::all(255));
  }
  cv::Mat result;
  if (!columns.empty()) cv::hconcat(columns, result);
  return result;
}

}  // namespace

ResidualPicture residual_picture(const cv::Mat& bgr, const calibration::PlaneMap& map,
                                 const vision::MarkerLayout& layout,
                                 std::span<const tracker::RobotReport> robots) {
  const tracker::PlaneGrid grid(map, bgr.cols, bgr.rows);
  Workshop workshop{grid, tracker::PoseAligner(layout, grid), {bgr.cols, bgr.rows}, {}, {}, {}};
  const tracker::DiscTemplate& robot = workshop.aligner.robot();
  cv::Mat drawn(bgr.size(), CV_8UC3, cv::Scalar::all(128));
  cv::Mat residual = drawn.clone();
  std::vector<cv::Mat> columns;
  for (const AlignedPose& pose : align_all(bgr, robots, workshop)) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(robot.disc_count); ++d)
      draw_disc(bgr, robot.radius_m[d], pose.discs[d], workshop, drawn, residual);
    const double reach_px = kMargin * robot.reach_m / grid.metres_per_pixel(pose.centre_px);
    const cv::Rect crop = crop_of(pose, reach_px, bgr.size());
    cv::vconcat(
        std::vector<cv::Mat>{enlarged(bgr(crop)), enlarged(drawn(crop)), enlarged(residual(crop))},
        columns.emplace_back());
  }
  return {.bgr = side_by_side(std::move(columns)),
          .left_grey = workshop.left.rms(),
          .marks_grey = workshop.marks.rms(),
          .blur_px = workshop.sensor.blur_px(),
          .noise_grey = std::sqrt(workshop.sensor.noise().variance(workshop.plates.mean()))};
}

}  // namespace nadir::bench
