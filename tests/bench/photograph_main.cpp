// photograph: robots of a real photograph, aligned. There is no truth for it, so this measures what
// can be measured: how far poses scatter when noise or JPEG disturbs the picture, beside the
// scatter that is published, and what the template leaves of the picture.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "calibration/field_points.h"
#include "calibration/fit/fit.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/json_file.h"
#include "tests/bench/residual_picture.h"
#include "tracker/camera_pipeline.h"

namespace {

using namespace nadir;
namespace fs = std::filesystem;

constexpr int kRepeats = 50;
constexpr int kFirstLooks = 60;  // of the undisturbed picture, until the camera is known

/// Gaussian noise of so many grey levels, then JPEG of this quality (0: none).
struct Disturbance {
  const char* name;
  double noise_grey;
  int jpeg_quality;
};
constexpr std::array<Disturbance, 6> kDisturbances = {{{"noise of 1 grey level", 1.0, 0},
                                                       {"noise of 2", 2.0, 0},
                                                       {"noise of 4", 4.0, 0},
                                                       {"noise of 2, JPEG quality 90", 2.0, 90},
                                                       {"noise of 2, JPEG quality 80", 2.0, 80},
                                                       {"noise of 2, JPEG quality 60", 2.0, 60}}};

/// One robot: how often it was found, and its aligned poses against the undisturbed picture's.
struct Scatter {
  int found = 0;
  int aligned = 0;
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares_px = Eigen::Vector2d::Zero();
  double sum_rad = 0.0, squares_rad = 0.0;
  Eigen::Vector3d published =
      Eigen::Vector3d::Zero();  // variances without the calibration's, m^2 and rad^2
};

/// Means over the robots; scatter RMS per axis.
struct Row {
  std::string disturbance;
  int robots = 0, looks = 0, found = 0, aligned = 0;
  double scatter_px = 0.0, scatter_mm = 0.0, scatter_deg = 0.0;
  double published_mm = 0.0, published_deg = 0.0;
  double shift_px = 0.0, shift_deg = 0.0;
};

cv::Mat disturbed(const cv::Mat& picture, const Disturbance& how, cv::RNG& random) {
  cv::Mat noise(picture.size(), CV_16SC3);
  random.fill(noise, cv::RNG::NORMAL, 0.0, how.noise_grey);
  cv::Mat result;
  cv::add(picture, noise, result, cv::noArray(), CV_8U);
  if (how.jpeg_quality == 0) return result;
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", result, bytes, {cv::IMWRITE_JPEG_QUALITY, how.jpeg_quality});
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

class Camera {
 public:
  Camera(const fs::path& folder, const cv::Size& size)
      : layout_(vision::load_marker_layout(fs::path(NADIR_DATA_DIR) / "layouts/league.yaml")),
        calibration_(calibrated(folder / "points.csv", layout_.height_m)),
        pipeline_({.camera = "photo",
                   .calibration = calibration_,
                   .calibration_file = folder / "points.csv",
                   .layouts = {layout_}},
                  size.width, size.height) {}

  const tracker::FrameReport& look(const cv::Mat& picture) {
    vision::Frame frame;
    frame.image = picture;
    frame.number = number_++;
    frame.capture_time = vision::CaptureTime(std::chrono::milliseconds(20 * frame.number));
    pipeline_.process(frame, 0.0, report_);
    return report_;
  }
  const vision::MarkerLayout& layout() const { return layout_; }
  const calibration::PlaneMap& map() const { return calibration_.map; }

 private:
  /// At the height of the marks: nothing is known of the camera's.
  static calibration::Calibration calibrated(const fs::path& file, double height_m) {
    const auto points = calibration::load_field_points(file);
    calibration::Calibration result{calibration::fit_polynomial2(points, {}).map};
    result.points_box = calibration::pixel_box(points);
    result.height_m = height_m;
    return result;
  }

  vision::MarkerLayout layout_;
  calibration::Calibration calibration_;
  tracker::CameraPipeline pipeline_;
  tracker::FrameReport report_;
  std::uint64_t number_ = 0;
};

Row summary(const Disturbance& how, const std::map<int, Scatter>& scatters, int looks,
            double mm_per_px) {
  Row row{.disturbance = how.name, .robots = static_cast<int>(scatters.size()), .looks = looks};
  double robots = 0.0;
  double variance_px2 = 0.0, variance_rad2 = 0.0, shift_px2 = 0.0, shift_rad2 = 0.0;
  Eigen::Vector3d published = Eigen::Vector3d::Zero();
  for (const auto& [id, scatter] : scatters) {
    const double n = scatter.aligned;
    row.found += scatter.found;
    row.aligned += scatter.aligned;
    if (scatter.aligned < 2) continue;
    ++robots;
    const Eigen::Vector2d mean_px = scatter.sum_px / n;
    const double mean_rad = scatter.sum_rad / n;
    variance_px2 += 0.5 * (scatter.squares_px / n - mean_px.cwiseAbs2()).sum();
    variance_rad2 += scatter.squares_rad / n - mean_rad * mean_rad;
    shift_px2 += 0.5 * mean_px.squaredNorm();
    shift_rad2 += mean_rad * mean_rad;
    published += scatter.published / n;
  }
  const double degrees = 180.0 / M_PI;
  row.scatter_px = std::sqrt(variance_px2 / robots);
  row.scatter_mm = row.scatter_px * mm_per_px;
  row.scatter_deg = std::sqrt(variance_rad2 / robots) * degrees;
  row.shift_px = std::sqrt(shift_px2 / robots);
  row.shift_deg = std::sqrt(shift_rad2 / robots) * degrees;
  row.published_mm = 1e3 * std::sqrt(0.5 * (published.x() + published.y()) / robots);
  row.published_deg = std::sqrt(published.z() / robots) * degrees;
  return row;
}

Row measure(const fs::path& folder, const cv::Mat& picture, const Disturbance& how) {
  Camera camera(folder, picture.size());
  for (int i = 0; i < kFirstLooks; ++i) camera.look(picture);
  std::map<int, tracker::RobotReport> reference;
  for (const auto& robot : camera.look(picture).robots) {
    if (robot.aligned) reference.emplace(robot.id, robot);
  }
  std::map<int, Scatter> scatters;
  cv::RNG random(1);
  for (int i = 0; i < kRepeats; ++i) {
    for (const auto& robot : camera.look(disturbed(picture, how, random)).robots) {
      const auto known = reference.find(robot.id);
      if (known == reference.end()) continue;
      Scatter& scatter = scatters[robot.id];
      const Eigen::Vector2d off_px = robot.centre_px - known->second.centre_px;
      const double off_rad = fusion::wrap_angle(robot.pose_world_robot.heading_rad -
                                                known->second.pose_world_robot.heading_rad);
      ++scatter.found;
      if (!robot.aligned) continue;
      ++scatter.aligned;
      scatter.sum_px += off_px;
      scatter.squares_px += off_px.cwiseAbs2();
      scatter.sum_rad += off_rad;
      scatter.squares_rad += off_rad * off_rad;
      scatter.published += robot.covariance.diagonal();
      scatter.published.head<2>() -=
          camera.map().calibration_covariance_m2(robot.centre_px).diagonal();
    }
  }
  const double mm_per_px =
      1e3 *
      std::sqrt(std::abs(
          camera.map().jacobian_m_per_px({picture.cols / 2.0, picture.rows / 2.0}).determinant()));
  return summary(how, scatters, kRepeats * static_cast<int>(reference.size()), mm_per_px);
}

void print(const std::vector<Row>& rows, const bench::ResidualPicture& picture) {
  fmt::print(
      "A real photograph ({} robots), disturbed {} times each: scatter of the poses, and what is "
      "published\n",
      rows.front().robots, kRepeats);
  fmt::print("{:<30} {:>9} {:>8} {:>22} {:>16} {:>18}\n", "", "found", "aligned",
             "scatter px, mm, deg", "published mm, deg", "mean shift px, deg");
  for (const Row& row : rows) {
    fmt::print(
        "{:<30} {:>4}/{:<4} {:>8} {:>8.4f} {:>6.3f} {:>6.3f} {:>10.3f} {:>6.3f} {:>11.4f} "
        "{:>6.3f}\n",
        row.disturbance, row.found, row.looks, row.aligned, row.scatter_px, row.scatter_mm,
        row.scatter_deg, row.published_mm, row.published_deg, row.shift_px, row.shift_deg);
  }
  fmt::print(
      "The template leaves {:.1f} grey levels RMS of discs with a contrast of {:.1f}; blur {:.2f} "
      "px, noise {:.1f}\n",
      picture.left_grey, picture.marks_grey, picture.blur_px, picture.noise_grey);
}

nlohmann::json as_json(const Row& row) {
  return {{"disturbance", row.disturbance},
          {"looks", row.looks},
          {"found", row.found},
          {"aligned", row.aligned},
          {"scatter_px", row.scatter_px},
          {"scatter_mm", row.scatter_mm},
          {"scatter_deg", row.scatter_deg},
          {"published_mm", row.published_mm},
          {"published_deg", row.published_deg},
          {"shift_px", row.shift_px},
          {"shift_deg", row.shift_deg}};
}

void run(const std::string& json_file, const std::string& picture_file) {
  const fs::path folder = fs::path(NADIR_REAL_DIR) / "ssl";
  const cv::Mat picture = cv::imread((folder / "field_daylight.jpg").string());
  if (picture.empty()) {
    fmt::print("SKIPPED, LOUDLY: the real photograph is not at {}\n", folder.string());
    bench::write_json_file({{"benchmark", "photograph"}, {"skipped", true}}, json_file);
    return;
  }
  std::vector<Row> rows;
  for (const Disturbance& how : kDisturbances) rows.push_back(measure(folder, picture, how));
  Camera camera(folder, picture.size());
  const bench::ResidualPicture residual =
      bench::residual_picture(picture, camera.map(), camera.layout(), camera.look(picture).robots);
  print(rows, residual);
  if (!picture_file.empty() && !residual.bgr.empty() && !cv::imwrite(picture_file, residual.bgr))
    throw std::runtime_error("cannot write " + picture_file);
  nlohmann::json list;
  for (const Row& row : rows) list.push_back(as_json(row));
  bench::write_json_file({{"benchmark", "photograph"},
                          {"disturbed", list},
                          {"residual_grey", residual.left_grey},
                          {"contrast_grey", residual.marks_grey},
                          {"blur_px", residual.blur_px},
                          {"noise_grey", residual.noise_grey}},
                         json_file);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("poses of a real photograph: repeatability, and what the template leaves");
  std::string json_file;
  std::string picture_file;
  app.add_option("--json", json_file, "write the figures to this file");
  app.add_option("--picture", picture_file, "write frame, template and residuals to this PNG");
  return nadir::bench::bench_main(argc, argv, app, [&] { run(json_file, picture_file); });
}
