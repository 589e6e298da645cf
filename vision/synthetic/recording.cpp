#include "vision/synthetic/recording.h"

#include <fmt/format.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>  // names of parameters only
#include <stdexcept>

#include "vision/pictures/codecs.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr std::uint64_t kPointsPurpose = 6;

std::ofstream opened(const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
  return stream;
}

void finished(std::ofstream& stream, const std::filesystem::path& file) {
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": writing failed, is the disk full?");
}

std::string truth_line(const Renderer& renderer, std::uint64_t frame) {
  std::string robots;
  for (const RobotTruth& robot : renderer.truth(frame)) {
    robots += fmt::format(
        "{}{{\"id\": {}, \"team\": \"{}\", \"x_m\": {:.9f}, \"y_m\": {:.9f}, "
        "\"heading_rad\": {:.9f}, \"u_px\": {:.6f}, \"v_px\": {:.6f}}}",
        robots.empty() ? "" : ", ", robot.id, robot.team, robot.x_m, robot.y_m, robot.heading_rad,
        robot.u_px, robot.v_px);
  }
  return fmt::format("{{\"frame\": {}, \"capture_ns\": {}, \"robots\": [{}]}}\n", frame,
                     renderer.capture_time(frame).time_since_epoch().count(), robots);
}

void write_points(const Renderer& renderer, std::uint64_t seed, const std::filesystem::path& file) {
  std::ofstream stream = opened(file);
  stream << "u_px,v_px,x_m,y_m\n";
  for (const CalibrationPoint& point :
       calibration_points(renderer.scene(), renderer.camera(), seed)) {
    stream << fmt::format("{:.6f},{:.6f},{:.9f},{:.9f}\n", point.pixel.x(), point.pixel.y(),
                          point.world_m.x(), point.world_m.y());
  }
  finished(stream, file);
}

void write_text(const std::string& text, const std::filesystem::path& file) {
  std::ofstream stream = opened(file);
  stream << text;
  finished(stream, file);
}

}  // namespace

std::vector<CalibrationPoint> calibration_points(const Scene& scene, const CameraModel& camera,
                                                 std::uint64_t seed) {
  RandomStream random(seed, 0, kPointsPurpose);
  std::vector<CalibrationPoint> points;
  for (int row = 0; row < scene.points.rows; ++row) {
    for (int column = 0; column < scene.points.columns; ++column) {
      PixelPoint pixel((camera.width_px() - 1.0) * column / (scene.points.columns - 1),
                       (camera.height_px() - 1.0) * row / (scene.points.rows - 1));
      Eigen::Vector2d world_m = camera.on_plane(pixel, scene.points.height_m);
      if (!world_m.allFinite()) continue;
      pixel += scene.points.noise_px * PixelPoint(random.normal(), random.normal());
      world_m += scene.points.survey_noise_m * Eigen::Vector2d(random.normal(), random.normal());
      points.push_back({pixel, world_m});
    }
  }
  return points;
}

void write_recording(Renderer& renderer, std::uint64_t seed, std::uint64_t frames,
                     const std::filesystem::path& folder,
                     const std::function<void(std::uint64_t)>& progress, PictureFormat format) {
  const std::filesystem::path pictures = folder / "frames";
  std::filesystem::create_directories(pictures);
  std::string times = "file,capture_ns\n";
  std::ofstream truth = opened(folder / "truth.jsonl");
  const bool is_jpeg = format == PictureFormat::kJpeg;
  const std::vector<int> parameters = is_jpeg ? std::vector<int>{cv::IMWRITE_JPEG_QUALITY, 95}
                                              : std::vector<int>{cv::IMWRITE_PNG_COMPRESSION, 1};
  cv::Mat image;
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    renderer.render(frame, image);
    const std::string name = fmt::format("{:06d}.{}", frame, is_jpeg ? "jpg" : "png");
    const std::filesystem::path file = pictures / name;
    if (!codecs().write(file.string(), image, parameters)) {
      throw std::runtime_error(file.string() + ": cannot be written");
    }
    times += fmt::format("{},{}\n", name, renderer.capture_time(frame).time_since_epoch().count());
    truth << truth_line(renderer, frame);
    progress(frame + 1);
  }
  finished(truth, folder / "truth.jsonl");
  // The folder source looks for the times beside the pictures, people look here.
  write_text(times, folder / "times.csv");
  write_text(times, pictures / "times.csv");
  write_points(renderer, seed, folder / "points.csv");
}

}  // namespace nadir::vision
