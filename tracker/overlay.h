#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/plane_map.h"
#include "tracker/pose_report.h"
#include "vision/marker_layout.h"

namespace nadir::tracker {

/// How much larger than life an overlay shows one standard deviation: true ones are a fraction of a
/// pixel.
inline constexpr double kOverlaySigmaFactor = 100.0;

/// Draws what the tracker says onto the picture that it was said of: a circle as large as each
/// robot's markers or the squares of its tags, an arrow along its heading, its number in its team's
/// colour, the one-sigma ellipse of its place and fan of its heading (both kOverlaySigmaFactor
/// times too large), rejected candidates with their reasons, and a legend.
class Overlay {
 public:
  /// `map` is the calibration that the poses were made with; `layouts` give the teams and their
  /// robots' sizes.
  Overlay(calibration::PlaneMap map, const std::vector<vision::MarkerLayout>& layouts);

  /// The picture with everything drawn on it, CV_8UC3. Small images (less than 1000 px wide) come
  /// twice as large. The result is valid until the next call.
  const cv::Mat& draw(const cv::Mat& bgr, const FrameReport& report);

 private:
  struct TeamStyle {
    std::string name;
    cv::Scalar colour;
    double robot_radius_m = 0.0;
    std::optional<vision::TagLayout> tags;
  };

  bool is_on_robot(const FrameReport& report, const vision::PixelPoint& pixel) const;
  const TeamStyle& style_of(std::string_view team) const;
  void draw_robot(const RobotReport& robot);
  void draw_outline(const RobotReport& robot, const TeamStyle& style);
  void draw_uncertainty(const RobotReport& robot, const TeamStyle& style);
  void draw_number(const RobotReport& robot, const TeamStyle& style);
  void draw_rejections(const FrameReport& report);
  void draw_scale_bar();
  void draw_legend(const FrameReport& report);
  cv::Rect free_corner(const cv::Size& size, const FrameReport& report) const;

  // A place of the plane near the robot, as a point of the canvas.
  cv::Point2d on_canvas(const RobotReport& robot, const Eigen::Vector2d& offset_world_m) const;
  void stroke(const std::vector<cv::Point2d>& line, const cv::Scalar& colour, int width,
              bool closed);
  void write(const std::string& text, const cv::Point2d& place, double size,
             const cv::Scalar& colour);

  calibration::PlaneMap map_;
  std::vector<TeamStyle> styles_;
  cv::Mat canvas_;
  int enlargement_ = 1;
};

}  // namespace nadir::tracker
