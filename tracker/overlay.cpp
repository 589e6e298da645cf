#include "tracker/overlay.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace nadir::tracker {
namespace {

constexpr int kSmallWidth_px = 1000;
constexpr int kOutlinePoints = 72;
constexpr int kFanSteps = 16;  // to either side
constexpr double kPi = 3.14159265358979323846;
constexpr int kSubPixelBits = 4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Scalar kShade(24, 24, 24);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kRejected(120, 120, 255);
const cv::Scalar kUncertainty(255, 255, 255);

// Brighter than the markers themselves, so that lines stand out on them.
cv::Scalar line_colour(vision::Colour colour) {
  switch (colour) {
    case vision::Colour::kBlue:
      return {255, 170, 60};
    case vision::Colour::kYellow:
      return {60, 230, 255};
    case vision::Colour::kPink:
      return {200, 120, 255};
    case vision::Colour::kGreen:
      return {130, 240, 120};
    case vision::Colour::kOrange:
      return {60, 160, 255};
    case vision::Colour::kWhite:
      return {255, 255, 255};
    case vision::Colour::kBlack:
      return {190, 190, 190};
  }
  return kWhite;
}

cv::Point fixed_point(const cv::Point2d& place) {
  constexpr double kOne = 1 << kSubPixelBits;
  return {static_cast<int>(std::lround(place.x * kOne)),
          static_cast<int>(std::lround(place.y * kOne))};
}

Eigen::Vector2d direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

}  // namespace

Overlay::Overlay(calibration::PlaneMap map, const std::vector<vision::MarkerLayout>& layouts)
    : map_(std::move(map)) {
  for (const vision::MarkerLayout& layout : layouts) {
    for (const vision::Team& team : layout.teams) {
      styles_.push_back(
          {team.name, line_colour(team.centre_colour), 1.08 * layout.extent_m(), layout.tags});
    }
  }
}

const Overlay::TeamStyle& Overlay::style_of(std::string_view team) const {
  const auto style = std::ranges::find(styles_, team, &TeamStyle::name);
  return style != styles_.end() ? *style : styles_.front();
}

const cv::Mat& Overlay::draw(const cv::Mat& bgr, const FrameReport& report) {
  enlargement_ = bgr.cols < kSmallWidth_px ? 2 : 1;
  if (enlargement_ > 1) {
    cv::resize(bgr, canvas_, {}, enlargement_, enlargement_, cv::INTER_CUBIC);
  } else {
    bgr.copyTo(canvas_);
  }
  draw_rejections(report);
  for (const RobotReport& robot : report.robots) draw_robot(robot);
  draw_scale_bar();
  draw_legend(report);
  return canvas_;
}

cv::Point2d Overlay::on_canvas(const RobotReport& robot,
                               const Eigen::Vector2d& offset_world_m) const {
  const Eigen::Vector2d pixel =
      robot.centre_px + map_.jacobian_m_per_px(robot.centre_px).inverse() * offset_world_m;
  // Pixel centres are whole numbers in both pictures: (u + 1/2) scales, u does not.
  return {(pixel.x() + 0.5) * enlargement_ - 0.5, (pixel.y() + 0.5) * enlargement_ - 0.5};
}

void Overlay::stroke(const std::vector<cv::Point2d>& line, const cv::Scalar& colour, int width,
                     bool closed) {
  std::vector<cv::Point> points;
  points.reserve(line.size());
  for (const cv::Point2d& point : line) points.push_back(fixed_point(point));
  // A dark seam keeps the line readable on any ground.
  cv::polylines(canvas_, points, closed, kShade, width + 2, cv::LINE_AA, kSubPixelBits);
  cv::polylines(canvas_, points, closed, colour, width, cv::LINE_AA, kSubPixelBits);
}

void Overlay::write(const std::string& text, const cv::Point2d& place, double size,
                    const cv::Scalar& colour) {
  const cv::Point at(static_cast<int>(place.x), static_cast<int>(place.y));
  cv::putText(canvas_, text, at, kFont, size, kShade, 3, cv::LINE_AA);
  cv::putText(canvas_, text, at, kFont, size, colour, 1, cv::LINE_AA);
}

void Overlay::draw_robot(const RobotReport& robot) {
  const TeamStyle& style = style_of(robot.team);
  draw_outline(robot, style);
  draw_uncertainty(robot, style);

  const double heading_rad = robot.pose_world_robot.heading_rad;
  const Eigen::Vector2d rim = style.robot_radius_m * direction(heading_rad);
  const Eigen::Vector2d tip = 1.6 * rim;
  const double wing_m = 0.34 * style.robot_radius_m;
  stroke({on_canvas(robot, rim), on_canvas(robot, tip)}, style.colour, 2, false);
  stroke({on_canvas(robot, tip - wing_m * direction(heading_rad + 0.5)), on_canvas(robot, tip),
          on_canvas(robot, tip - wing_m * direction(heading_rad - 0.5))},
         style.colour, 2, false);
  draw_number(robot, style);
}

void Overlay::draw_outline(const RobotReport& robot, const TeamStyle& style) {
  std::vector<cv::Point2d> outline;
  outline.reserve(kOutlinePoints);
  for (int i = 0; i < kOutlinePoints; ++i) {
    outline.push_back(
        on_canvas(robot, style.robot_radius_m * direction(2.0 * kPi * i / kOutlinePoints)));
  }
  if (!style.tags) {
    stroke(outline, style.colour, 2, true);
    return;
  }
  const Eigen::Rotation2Dd world_from_robot(robot.pose_world_robot.heading_rad);
  for (const vision::MountedTag& tag : style.tags->tags_of(robot.id)) {
    const Eigen::Rotation2Dd robot_from_tag(tag.mount.heading_robot_rad);
    const double half_m = 0.5 * style.tags->size_m;
    outline.clear();
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      const Eigen::Vector2d corner_m =
          tag.mount.position_robot_m + robot_from_tag * Eigen::Vector2d(half_m * x, half_m * y);
      outline.push_back(on_canvas(robot, world_from_robot * corner_m));
    }
    stroke(outline, style.colour, 2, true);
  }
}

void Overlay::draw_uncertainty(const RobotReport& robot, const TeamStyle& style) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(robot.covariance.topLeftCorner<2, 2>());
  if (!robot.covariance.allFinite() || axes.eigenvalues().minCoeff() < 0.0) return;
  const Eigen::Matrix2d half_axes_m =
      kOverlaySigmaFactor * axes.eigenvectors() * axes.eigenvalues().cwiseSqrt().asDiagonal();
  std::vector<cv::Point2d> ellipse;
  ellipse.reserve(kOutlinePoints);
  for (int i = 0; i < kOutlinePoints; ++i) {
    ellipse.push_back(on_canvas(robot, half_axes_m * direction(2.0 * kPi * i / kOutlinePoints)));
  }
  stroke(ellipse, kUncertainty, 1, true);

  const double spread_rad =
      std::min(kOverlaySigmaFactor * std::sqrt(robot.covariance(2, 2)), 0.5 * kPi);
  std::vector<cv::Point2d> fan;
  fan.reserve(2 * kFanSteps + 1);
  for (int i = -kFanSteps; i <= kFanSteps; ++i) {
    const double angle_rad = robot.pose_world_robot.heading_rad + spread_rad * i / kFanSteps;
    fan.push_back(on_canvas(robot, 1.25 * style.robot_radius_m * direction(angle_rad)));
  }
  stroke(fan, kUncertainty, 1, false);
}

// A plate in the team's colour, behind the robot where its arrow does not point, wholly in the
// picture.
void Overlay::draw_number(const RobotReport& robot, const TeamStyle& style) {
  constexpr double kSize = 0.55;
  const std::string text = fmt::format("{}", robot.id);
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, kFont, kSize, 2, &baseline);
  const cv::Size plate(extent.width + 12, extent.height + 10);
  const Eigen::Vector2d back = -direction(robot.pose_world_robot.heading_rad);
  const cv::Point2d rim = on_canvas(robot, style.robot_radius_m * back);
  const cv::Point2d middle = on_canvas(robot, Eigen::Vector2d::Zero());
  const cv::Point2d outward = (rim - middle) / std::max(1.0, cv::norm(rim - middle));
  const cv::Point2d centre = rim + outward * (0.5 * std::hypot(plate.width, plate.height) + 2.0);
  const auto inside = [](double low, int length, int limit) {
    return std::clamp(static_cast<int>(low), 0, std::max(0, limit - length));
  };
  const cv::Rect box({inside(centre.x - 0.5 * plate.width, plate.width, canvas_.cols),
                      inside(centre.y - 0.5 * plate.height, plate.height, canvas_.rows)},
                     plate);
  cv::rectangle(canvas_, box, style.colour, cv::FILLED, cv::LINE_AA);
  cv::rectangle(canvas_, box, kShade, 1, cv::LINE_AA);
  cv::putText(canvas_, text, {box.x + 6, box.y + 5 + extent.height}, kFont, kSize, kShade, 2,
              cv::LINE_AA);
}

bool Overlay::is_on_robot(const FrameReport& report, const vision::PixelPoint& pixel) const {
  return std::ranges::any_of(report.robots, [&](const RobotReport& robot) {
    const Eigen::Vector2d away_m =
        map_.plane_from_pixel(pixel) - robot.pose_world_robot.position_m();
    return away_m.norm() < style_of(robot.team).robot_radius_m;
  });
}

void Overlay::draw_rejections(const FrameReport& report) {
  std::vector<cv::Rect> written;
  for (const RejectionReport& rejection : report.rejected) {
    const cv::Point2d at((rejection.centre_px.x() + 0.5) * enlargement_ - 0.5,
                         (rejection.centre_px.y() + 0.5) * enlargement_ - 0.5);
    constexpr double kArm_px = 3.0;
    stroke({at - cv::Point2d(kArm_px, kArm_px), at + cv::Point2d(kArm_px, kArm_px)}, kRejected, 1,
           false);
    stroke({at - cv::Point2d(kArm_px, -kArm_px), at + cv::Point2d(kArm_px, -kArm_px)}, kRejected, 1,
           false);
    // A reason is written where it hides no other and no robot that was found.
    if (is_on_robot(report, rejection.centre_px)) continue;
    constexpr double kSize = 0.36;
    int baseline = 0;
    const cv::Size extent = cv::getTextSize(rejection.reason, kFont, kSize, 1, &baseline);
    const cv::Rect box(static_cast<int>(at.x) + 7, static_cast<int>(at.y) - 6, extent.width,
                       extent.height + 6);
    const auto overlaps = [&](const cv::Rect& other) { return (box & other).area() > 0; };
    if (std::ranges::any_of(written, overlaps)) continue;
    written.push_back(box);
    write(rejection.reason, at + cv::Point2d(7.0, 4.0), kSize, kRejected);
  }
}

void Overlay::draw_scale_bar() {
  const Eigen::Vector2d middle(0.5 * canvas_.cols / enlargement_,
                               0.5 * canvas_.rows / enlargement_);
  const double m_per_px = map_.jacobian_m_per_px(middle).col(0).norm() / enlargement_;
  double length_m = 1.0;
  while (length_m / m_per_px > 0.25 * canvas_.cols) length_m /= 2.0;
  const double length_px = length_m / m_per_px;
  const cv::Point2d right(canvas_.cols - 16.0, canvas_.rows - 16.0);
  const cv::Point2d left = right - cv::Point2d(length_px, 0.0);
  const cv::Point2d tick(0.0, 5.0);
  stroke({left - tick, left, right, right - tick}, kWhite, 2, false);
  write(fmt::format("{:g} m", length_m), left + cv::Point2d(0.0, -8.0), 0.45, kWhite);
}

// The corner that hides the fewest robots; the lower right one has the scale bar.
cv::Rect Overlay::free_corner(const cv::Size& size, const FrameReport& report) const {
  constexpr int kMargin_px = 8;
  const cv::Size cut(std::min(size.width, canvas_.cols), std::min(size.height, canvas_.rows));
  const int right = std::max(0, canvas_.cols - cut.width - kMargin_px);
  const int bottom = std::max(0, canvas_.rows - cut.height - kMargin_px);
  const int left = std::min(kMargin_px, canvas_.cols - cut.width);
  const int top = std::min(kMargin_px, canvas_.rows - cut.height);
  const std::array<cv::Point, 3> corners = {cv::Point(left, top), cv::Point(right, top),
                                            cv::Point(left, bottom)};
  const auto hidden = [&](const cv::Point& corner) {
    const cv::Rect reach(corner.x - 40, corner.y - 40, cut.width + 80, cut.height + 80);
    return std::ranges::count_if(report.robots, [&](const RobotReport& robot) {
      return reach.contains(cv::Point(on_canvas(robot, Eigen::Vector2d::Zero())));
    });
  };
  return {*std::ranges::min_element(corners, {}, hidden), cut};
}

void Overlay::draw_legend(const FrameReport& report) {
  const std::array<std::string, 3> lines = {
      fmt::format("{}   frame {}", report.camera, report.frame),
      fmt::format("{} robots, {} rejected   {:.2f} ms", report.robots.size(),
                  report.rejected.size(), 1e-3 * report.stages.total_us),
      fmt::format("white: 1 sigma of place and heading, x {:g}", kOverlaySigmaFactor)};
  constexpr double kSize = 0.5;
  constexpr int kLine_px = 21;
  int width = 0;
  int baseline = 0;
  for (const std::string& line : lines) {
    width = std::max(width, cv::getTextSize(line, kFont, kSize, 1, &baseline).width);
  }
  const cv::Rect panel =
      free_corner({width + 20, kLine_px * static_cast<int>(lines.size()) + 12}, report);
  cv::Mat ground = canvas_(panel);
  cv::addWeighted(ground, 0.3, cv::Mat(ground.size(), ground.type(), kShade), 0.7, 0.0, ground);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    cv::putText(canvas_, lines[i], {panel.x + 10, panel.y + kLine_px * static_cast<int>(i + 1) - 1},
                kFont, kSize, kWhite, 1, cv::LINE_AA);
  }
}

}  // namespace nadir::tracker
