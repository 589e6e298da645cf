#include "tracker/alignment/robot_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace nadir::tracker {
namespace {

constexpr double kSettled_px = 0.03;
constexpr double kNear_px = 0.5;
constexpr double kNoLimit = 1e9;
constexpr double kSuspicious = 1.25;        // chi-square per degree of freedom
constexpr double kSuspicious_sigmas = 3.0;  // beyond what chance makes of it
// A slope of the light of 1 per pixel shifts a disc by so many radii and blurs; a shadow's edge is
// no even slope, so twice what a slope would do.
constexpr double kShadingError = 2.4;
constexpr double kNoShadow = 4.0;          // of structure: such a disc teaches little
constexpr double kStructureOfNoise = 0.8;  // what chance may add to 1
constexpr double kGatherAgain_px = 0.75;   // pixels were gathered for a place this far away
constexpr double kLongestStep_radii = 0.5;
constexpr double kMisfitPrior_dof = 4.0;  // few discs' misfit is mostly chance
constexpr double kLeastPixels = 9.0;      // values that count: levels and centre take 8 of them

}  // namespace

RobotFit::RobotFit(const DiscTemplate& robot, const PlaneGrid& grid,
                   const AlignmentSettings& settings)
    : robot_(robot),
      settings_(settings),
      view_(robot, grid, settings),
      discs_(static_cast<std::size_t>(robot.disc_count)) {}

void RobotFit::begin(const fusion::PlanarPose& guess, bool is_near) {
  place_ = RobotPlace(guess);
  last_step_px_ = is_near ? 0.9 * kNear_px : kNoLimit;
  inflation_.fill(1.0);
  structure_.fill(1.0);
  shading_m2_.fill(0.0);
  counts_.fill(false);
}

bool RobotFit::is_near() const { return last_step_px_ < kNear_px; }
bool RobotFit::is_settled() const { return last_step_px_ < kSettled_px; }

int RobotFit::counting_discs() const {
  return static_cast<int>(std::count(counts_.begin(), counts_.end(), true));
}

bool RobotFit::is_uneven(std::size_t disc) const {
  return structure_[disc] > kNoShadow || shading_m2_[disc] > 0.0;
}

OutlierLimits RobotFit::limits() const {
  return {settings_.huber_sigmas, is_near() ? settings_.far_sigmas : kNoLimit};
}

bool RobotFit::gather(const FramePixels& frame, const vision::PixelPoint& near_px, double blur_px,
                      std::span<const Obstacle> obstacles) {
  if (!view_.aim(place_, near_px, blur_px, obstacles)) return false;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    counts_[i] = view_.gather(frame, place_, i, false, discs_[i]);
    is_whole_[i] = false;
    if (counts_[i]) discs_[i].start(view_.edge(i), centre_m(i));
  }
  gathered_at_ = place_;
  return counting_discs() > 0;
}

bool RobotFit::must_gather() const {
  const Eigen::Vector3d moved = fusion::pose_difference(place_.pose(), gathered_at_.pose());
  return moved.head<2>().norm() + robot_.reach_m * std::abs(moved.z()) >
         kGatherAgain_px * view_.m_per_px();
}

bool RobotFit::gather_whole(const FramePixels& frame, std::size_t disc) {
  if (!view_.gather(frame, place_, disc, true, discs_[disc])) return false;
  is_whole_[disc] = true;
  discs_[disc].start_anew(view_.edge(disc), centre_m(disc));
  set_neighbours(disc);
  return true;
}

void RobotFit::set_neighbours(std::size_t i) {
  DiscState& disc = discs_[i];
  for (int n = 0; n < 2 && disc.neighbours[static_cast<std::size_t>(n)] >= 0; ++n) {
    const auto k = static_cast<std::size_t>(disc.neighbours[static_cast<std::size_t>(n)]);
    disc.set_neighbour(n, view_.edge(k), centre_m(k), discs_[k].levels);
  }
}

void RobotFit::evaluate(const PixelNoise& noise) {
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    if (!counts_[i]) continue;
    set_neighbours(i);
    evidence_[i] = discs_[i].evaluate(view_.edge(i), centre_m(i), noise, limits());
    if (evidence_[i].pixels < kLeastPixels) counts_[i] = false;
  }
}

bool RobotFit::is_suspicious(std::size_t i) const {
  const CentreEvidence& e = evidence_[i];
  // Where the disc itself fits best: of a place that is a little off, the rigid pattern's misfit
  // tells.
  const Eigen::Vector2d own_m = e.own_step_m();
  const double chance = kSuspicious_sigmas * std::sqrt(2.0 / e.pixels);
  const double pull_chance = chance / std::sqrt(CentreEvidence::kPullShare);
  return e.chi_square_per_dof(own_m) > std::max(kSuspicious, 1.0 + chance) ||
         e.pull_ratio_after(own_m) > std::max(kSuspicious, 1.0 + pull_chance);
}

void RobotFit::look_at_structure(const FramePixels& frame, const PixelNoise& noise) {
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    structure_[i] = 1.0;
    shading_m2_[i] = 0.0;
    if (!counts_[i]) continue;
    if (!is_whole_[i]) {
      if (!is_suspicious(i) || !gather_whole(frame, i)) continue;
      evidence_[i] = discs_[i].evaluate(view_.edge(i), centre_m(i), noise, limits());
    }
    const double misfit = evidence_[i].misfit(evidence_[i].own_step_m());
    structure_[i] =
        std::max(1.0, discs_[i].structure(evidence_[i], noise, limits()) - kStructureOfNoise);
    const DiscState::Slope slope = discs_[i].light_slope(noise);
    const double certain =
        std::max(0.0, slope.per_px.norm() - 3.0 * std::sqrt(misfit) * slope.deviation_per_px);
    shading_m2_[i] = std::pow(kShadingError * robot_.radius_m[i] * view_.blur_px() * certain, 2);
  }
}

// Beyond half a radius a disc's linear model means nothing.
void RobotFit::shorten_step() {
  double share = 1.0;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    if (!counts_[i]) continue;
    const double moved_m = (place_.lever(robot_.place_m[i]) * last_step_).norm();
    share = std::min(share, kLongestStep_radii * robot_.radius_m[i] / std::max(moved_m, 1e-12));
  }
  last_step_ *= share;
}

// Of a disc's centre, from its own pixels.
Eigen::Matrix2d RobotFit::covariance_m2(std::size_t i, double floor_m2) const {
  return evidence_[i].information.inverse() * inflation_[i] +
         (floor_m2 + shading_m2_[i]) * Eigen::Matrix2d::Identity();
}

bool RobotFit::step() {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    if (!counts_[i]) continue;
    const Eigen::Matrix<double, 2, 3> a = place_.lever(robot_.place_m[i]);
    const Eigen::Matrix2d weight = covariance_m2(i, 0.0).inverse();
    information += a.transpose() * weight * a;
    gradient += a.transpose() * (weight * evidence_[i].own_step_m());
  }
  // Compared in metres: the heading by way of the outermost rim.
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / robot_.reach_m);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  if (!(scaled.determinant() > 1e-9 * std::pow(scaled.trace() / 3.0, 3.0))) return false;
  last_step_ = information.inverse() * gradient;
  shorten_step();
  double longest_m = 0.0;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    if (!counts_[i]) continue;
    const Eigen::Vector2d moved_m = place_.lever(robot_.place_m[i]) * last_step_;
    discs_[i].follow(moved_m);
    longest_m = std::max(longest_m, moved_m.norm());
    inflation_[i] = std::max(structure_[i], evidence_[i].misfit(moved_m));
  }
  place_ = place_.moved(last_step_);
  last_step_px_ = longest_m / view_.m_per_px();
  return true;
}

int RobotFit::drop_covered(const ExpectedLook& look) {
  const int before = counting_discs();
  std::array<double, vision::kMaxDiscs> amplitudes{};
  std::array<double, vision::kMaxDiscs> seen_amplitudes{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    if (!counts_[i]) continue;
    const auto& levels = discs_[i].levels;
    const ChannelVector seen(levels[0].contrast, levels[1].contrast, levels[2].contrast);
    const ChannelVector& expected = look.contrast[i];
    const double along = seen.dot(expected);
    if (along < settings_.least_cosine * seen.norm() * expected.norm()) {
      counts_[i] = false;
      continue;
    }
    amplitudes[i] = along / expected.squaredNorm();
    seen_amplitudes[count++] = amplitudes[i];
  }
  if (count == 0) return before;
  // With an even number the larger one of the two in the middle: a faded pair is no measure.
  const std::span<double> all(seen_amplitudes.data(), count);
  std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(count / 2));
  const double median = all[count / 2];
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    if (counts_[i] && amplitudes[i] < settings_.least_amplitude * median) counts_[i] = false;
  }
  return before - counting_discs();
}

void RobotFit::finish(AlignedPose& result) const {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double misfit = 0.0;
  result.uneven_light = false;
  const double floor_m2 = std::pow(settings_.floor_px * view_.m_per_px(), 2);
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    AlignedDisc& disc = result.discs[i];
    disc = {};
    disc.centre_px = view_.pixel(centre_m(i));
    disc.counts = counts_[i];
    if (!counts_[i]) continue;
    const Eigen::Matrix<double, 2, 3> a = place_.lever(robot_.place_m[i]);
    const Eigen::Matrix2d weight = covariance_m2(i, floor_m2).inverse();
    information += a.transpose() * weight * a;
    const Eigen::Vector2d off_m = evidence_[i].own_step_m() - a * last_step_;
    misfit += off_m.dot(weight * off_m);
    for (std::size_t c = 0; c < 3; ++c) {
      disc.level[static_cast<Eigen::Index>(c)] = discs_[i].levels[c].level;
      disc.contrast[static_cast<Eigen::Index>(c)] = discs_[i].levels[c].contrast;
    }
    disc.pixels = discs_[i].pixels_in_disc();
    disc.chi_square_per_dof = inflation_[i];
    result.uneven_light = result.uneven_light || shading_m2_[i] > 0.0;
  }
  result.counting_discs = counting_discs();
  const double dof = 2.0 * result.counting_discs - 3.0;
  result.misfit = misfit / dof;
  result.covariance =
      information.inverse() * std::max(1.0, (misfit + kMisfitPrior_dof) / (dof + kMisfitPrior_dof));
  result.pose_world_robot = place_.pose();
}

}  // namespace nadir::tracker
