#include "tracker/alignment/pose_aligner.h"

#include <cmath>

#include "tracker/alignment/robot_fit.h"
#include "tracker/alignment/sensor_lesson.h"

namespace nadir::tracker {
namespace {

constexpr int kMostIterations = 10;
constexpr int kLeastDiscs = 2;
constexpr int kMostCovered = 1;          // discs; a second one, and it is not certain who it is
constexpr double kFarthest_radii = 1.5;  // from the guess: beyond it another place is found
constexpr double kFarthest_rad = 0.6;

}  // namespace

PoseAligner::PoseAligner(const vision::MarkerLayout& layout, const PlaneGrid& grid,
                         const AlignmentSettings& settings)
    : settings_(settings), fit_(std::make_unique<RobotFit>(template_of(layout), grid, settings)) {}
PoseAligner::~PoseAligner() = default;
PoseAligner::PoseAligner(PoseAligner&&) noexcept = default;
PoseAligner& PoseAligner::operator=(PoseAligner&&) noexcept = default;

const DiscTemplate& PoseAligner::robot() const { return fit_->robot(); }

void PoseAligner::fetch_meanwhile(const vision::PixelFetch& next) { meanwhile_ = next; }

bool PoseAligner::align(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor,
                        const PoseGuess& guess, const ExpectedLook* look,
                        std::span<const Obstacle> obstacles, AlignedPose& result) {
  const FramePixels frame{image, mosaic, sensor.light, &meanwhile_};
  const double farthest_m = kFarthest_radii * fit_->robot().radius_m[0];
  // Of a robot that is followed the first step is mostly the last but one.
  fit_->begin(guess.pose_world_robot, look != nullptr);
  int covered = 0;
  for (result.iterations = 1; result.iterations <= kMostIterations; ++result.iterations) {
    if (result.iterations == 1 || fit_->must_gather()) {
      const bool seen = fit_->gather(frame, guess.centre_px, sensor.blur_px(), obstacles);
      meanwhile_.all_rows();
      if (!seen) return false;
      covered = 0;
    }
    fit_->evaluate(sensor.noise());
    if (look != nullptr) covered += fit_->drop_covered(*look);
    if (covered > kMostCovered) return false;
    const bool near = fit_->is_near();
    if (near) fit_->look_at_structure(frame, sensor.noise());
    if (fit_->counting_discs() < kLeastDiscs || !fit_->step()) return false;
    const Eigen::Vector3d away =
        fusion::pose_difference(fit_->place().pose(), guess.pose_world_robot);
    if (away.head<2>().norm() > farthest_m || std::abs(away.z()) > kFarthest_rad) return false;
    if (!near || !fit_->is_settled()) continue;
    fit_->finish(result);
    result.centre_px = fit_->view().pixel(fit_->place().pose().position_m());
    return true;
  }
  return false;
}

void PoseAligner::teach(const cv::Mat& image, Mosaic mosaic, unsigned lesson, SensorModel& sensor) {
  const std::size_t disc = lesson % static_cast<std::size_t>(fit_->robot().disc_count);
  tracker::teach(image, mosaic, disc, *fit_, sensor,
                 {settings_.huber_sigmas, settings_.far_sigmas});
}

}  // namespace nadir::tracker
