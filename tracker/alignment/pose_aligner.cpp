#include "tracker/alignment/pose_aligner.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tracker/alignment/disc_state.h"

namespace nadir::tracker {
namespace {

constexpr int kMostIterations = 10;
constexpr double kSettled_px = 0.03;  // the step after this one would be smaller than any error
constexpr double kNear_px = 0.5;      // after a step of this length the next is in the noise
constexpr double kNoLimit = 1e9;
constexpr double kSuspicious = 1.15;  // chi-square per degree of freedom
// A slope of the light of 1 per pixel shifts a disc by so many radii and blurs; a shadow's edge is
// no even slope, so twice what a slope would do.
constexpr double kShadingError = 2.4;
constexpr double kKnownBlur_px = 0.01;
constexpr double kNoShadow = 4.0;          // of structure: such a disc teaches little
constexpr double kStructureOfNoise = 0.8;  // what chance may add to 1
constexpr double kGatherAgain_px = 0.75;   // pixels were gathered for a place this far away
constexpr double kLongestStep_radii = 0.5;
constexpr double kFarthest_radii = 1.5;  // from the guess: beyond it another place is found
constexpr double kFarthest_rad = 0.6;
constexpr double kReach_sigmas = 2.7;     // so far reach the edges of two neighbours together
constexpr double kMisfitPrior_dof = 4.0;  // few discs' misfit is mostly chance
constexpr int kMostCovered = 1;           // discs; a second one, and it is not certain who it is
constexpr double kLeastInside = 12.0;     // pixels, to see a slope of light
constexpr double kLeastLevel = 30.0;      // grey levels: darker, and noise is all there is
constexpr double kLeastPixels = 12.0;     // values that count, else a disc is out of the image

}  // namespace

struct PoseAligner::State {
  State(const vision::MarkerLayout& layout, const PlaneGrid& plane_grid,
        const AlignmentSettings& alignment_settings)
      : robot(template_of(layout)),
        grid(&plane_grid),
        settings(alignment_settings),
        discs(static_cast<std::size_t>(robot.disc_count)) {}

  struct Turn {  // of the robot in the world
    explicit Turn(double heading_rad) : c(std::cos(heading_rad)), s(std::sin(heading_rad)) {}
    Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
      return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
    }
    double c, s;
  };

  Eigen::Vector2d disc_centre_m(std::size_t i) const {
    return pose.position_m() + Turn(pose.heading_rad)(robot.place_m[i]);
  }
  DiscEdge edge(std::size_t i) const { return {robot.radius_m[i], blur_px}; }

  bool gather_discs(const cv::Mat& image, Mosaic mosaic, const LightShape& light,
                    std::span<const Obstacle> obstacles, const vision::PixelPoint& centre_px);
  void find_neighbours();
  void update_neighbours();
  void evaluate_discs(const PixelNoise& noise);
  void look_at_structure(const PixelNoise& noise);
  OutlierLimits limits() const {
    return {settings.huber_sigmas, last_step_px < kNear_px ? settings.far_sigmas : kNoLimit};
  }
  int judge_looks(const ExpectedLook* look);
  bool step();
  void shorten_step();
  Eigen::Matrix<double, 2, 3> lever(std::size_t i) const;
  void finish(AlignedPose& result) const;
  void teach_light(LightShape& light, const DiscState& disc, const ChannelLevels& levels,
                   const ChannelScatter& scatter, const PixelNoise& noise) const;

  DiscTemplate robot;
  const PlaneGrid* grid;
  AlignmentSettings settings;
  std::vector<DiscState> discs;
  std::array<CentreEvidence, vision::kMaxDiscs> evidence;
  std::array<double, vision::kMaxDiscs>
      inflation{};  // variance of a disc's pixels over their noise
  std::array<double, vision::kMaxDiscs> structure{};
  std::array<double, vision::kMaxDiscs> shading_m2{};  // variance of a centre by uneven light
  std::array<bool, vision::kMaxDiscs> counts{};
  fusion::PlanarPose pose;
  fusion::PlanarPose gathered_at;
  double blur_px = 0.0;
  double m_per_px = 0.0;  // about the robot
  double last_step_px = 0.0;
  Eigen::Vector3d last_step = Eigen::Vector3d::Zero();
  std::size_t taught_disc = 0;
};

bool PoseAligner::State::gather_discs(const cv::Mat& image, Mosaic mosaic, const LightShape& light,
                                      std::span<const Obstacle> obstacles,
                                      const vision::PixelPoint& centre_px) {
  find_neighbours();
  const double rim_m = settings.rim_sigmas * blur_px * m_per_px;
  std::array<Obstacle, kMostObstacles> near;
  int near_count = 0;
  for (const Obstacle& obstacle : obstacles) {
    const double apart_m = (obstacle.place_m - pose.position_m()).norm();
    if (near_count == kMostObstacles ||
        apart_m > obstacle.radius_m + robot.plate.radius_m + rim_m + 3.0 * m_per_px) {
      continue;
    }
    near[static_cast<std::size_t>(near_count++)] = {obstacle.place_m, obstacle.radius_m + rim_m};
  }
  const Turn turn(pose.heading_rad);
  // Of a far robot's outermost discs half at least must stay, though the rim's blur reaches them.
  const double own_rim_m = std::min(rim_m, robot.plate.radius_m - robot.least_plate_m);
  const PlateShape plate{robot.plate.radius_m - own_rim_m, robot.plate.front_m - own_rim_m};
  bool any = false;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const Eigen::Vector2d centre_m = disc_centre_m(i);
    const auto pixel = grid->pixel_near(centre_m, centre_px);
    counts[i] =
        pixel && gather(image, mosaic, *grid,
                        {centre_m, *pixel, robot.radius_m[i], settings.margin_sigmas * blur_px},
                        discs[i].patch);
    if (!counts[i]) continue;
    any = true;
    flatten(*pixel, light.slope_per_px(*pixel), discs[i].patch);
    mask(plate, pose.position_m(), turn({1.0, 0.0}), near.data(), near_count, discs[i].patch);
    for (const int other : discs[i].neighbours) {
      if (other < 0) continue;
      const auto k = static_cast<std::size_t>(other);
      leave_to(centre_m, robot.radius_m[i], disc_centre_m(k), robot.radius_m[k], discs[i].patch);
    }
  }
  gathered_at = pose;
  return any;
}

// Discs whose edges are so near that their blurs meet.
void PoseAligner::State::find_neighbours() {
  for (std::size_t i = 0; i < discs.size(); ++i) {
    discs[i].neighbours = {-1, -1};
    std::size_t count = 0;
    for (std::size_t k = 0; k < discs.size() && count < 2; ++k) {
      const double gap_m =
          (robot.place_m[i] - robot.place_m[k]).norm() - robot.radius_m[i] - robot.radius_m[k];
      if (k == i || gap_m > 2.0 * kReach_sigmas * blur_px * m_per_px) continue;
      discs[i].neighbours[count++] = static_cast<int>(k);
    }
  }
}

void PoseAligner::State::update_neighbours() {
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!counts[i]) continue;
    for (int n = 0; n < 2 && discs[i].neighbours[static_cast<std::size_t>(n)] >= 0; ++n) {
      const auto k = static_cast<std::size_t>(discs[i].neighbours[static_cast<std::size_t>(n)]);
      discs[i].set_neighbour(n, edge(k), disc_centre_m(k), discs[k].levels);
    }
  }
}

void PoseAligner::State::evaluate_discs(const PixelNoise& noise) {
  update_neighbours();
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!counts[i]) continue;
    evidence[i] = discs[i].evaluate(edge(i), disc_centre_m(i), noise, limits());
    if (evidence[i].pixels < kLeastPixels) counts[i] = false;
  }
}

// Where residuals are larger than noise: whether neighbouring pixels err together.
void PoseAligner::State::look_at_structure(const PixelNoise& noise) {
  for (std::size_t i = 0; i < discs.size(); ++i) {
    structure[i] = 1.0;
    shading_m2[i] = 0.0;
    if (!counts[i]) continue;
    const double chi_square =
        std::max(evidence[i].chi_square_per_dof(Eigen::Vector2d::Zero()), evidence[i].pull_ratio);
    if (chi_square < kSuspicious) continue;
    structure[i] =
        std::max(1.0, discs[i].structure(evidence[i], noise, limits()) - kStructureOfNoise);
    const DiscState::Slope slope = discs[i].light_slope(noise);
    const double certain =
        std::max(0.0, slope.per_px.norm() - 3.0 * std::sqrt(chi_square) * slope.deviation_per_px);
    shading_m2[i] = std::pow(kShadingError * robot.radius_m[i] * blur_px * certain, 2);
  }
}

// d(disc's centre)/d(x, y, heading).
Eigen::Matrix<double, 2, 3> PoseAligner::State::lever(std::size_t i) const {
  const Eigen::Vector2d arm = Turn(pose.heading_rad)(robot.place_m[i]);
  Eigen::Matrix<double, 2, 3> a;
  a << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
  return a;
}

// Beyond half a radius a disc's linear model means nothing.
void PoseAligner::State::shorten_step() {
  double share = 1.0;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!counts[i]) continue;
    const double moved_m = (lever(i) * last_step).norm();
    share = std::min(share, kLongestStep_radii * robot.radius_m[i] / std::max(moved_m, 1e-12));
  }
  last_step *= share;
}

// One step of the pose, and the levels with it. False if the discs do not determine a pose.
bool PoseAligner::State::step() {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!counts[i]) continue;
    const Eigen::Matrix<double, 2, 3> a = lever(i);
    const Eigen::Matrix2d own_m2 = evidence[i].information.inverse();
    const Eigen::Matrix2d weight =
        (own_m2 * inflation[i] + shading_m2[i] * Eigen::Matrix2d::Identity()).inverse();
    information += a.transpose() * weight * a;
    gradient += a.transpose() * weight * own_m2 * evidence[i].gradient;
  }
  // Compared in metres: the heading by way of the outermost rim.
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / robot.reach_m);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  if (!(scaled.determinant() > 1e-9 * std::pow(scaled.trace() / 3.0, 3.0))) return false;
  last_step = information.inverse() * gradient;
  shorten_step();
  double longest_m = 0.0;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!counts[i]) continue;
    const Eigen::Vector2d moved_m = lever(i) * last_step;
    discs[i].follow(moved_m);
    longest_m = std::max(longest_m, moved_m.norm());
    inflation[i] =
        std::max({structure[i], evidence[i].chi_square_per_dof(moved_m), evidence[i].pull_ratio});
  }
  pose.x_m += last_step.x();
  pose.y_m += last_step.y();
  pose.heading_rad = fusion::wrap_angle(pose.heading_rad + last_step.z());
  last_step_px = longest_m / m_per_px;
  return true;
}

// A disc that does not have the colour that was there before is covered, or is no disc at all.
// Chi-square does not see it, since the levels are free. Returns how many there are.
int PoseAligner::State::judge_looks(const ExpectedLook* look) {
  if (look == nullptr) return 0;
  const auto before = std::count(counts.begin(), counts.end(), true);
  std::array<double, vision::kMaxDiscs> amplitudes{};
  std::array<double, vision::kMaxDiscs> sorted{};  // falling
  std::size_t count = 0;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!counts[i]) continue;
    const auto& levels = discs[i].levels;
    const ChannelVector seen(levels[0].contrast, levels[1].contrast, levels[2].contrast);
    const ChannelVector& expected = look->contrast[i];
    const double along = seen.dot(expected);
    if (along < settings.least_cosine * seen.norm() * expected.norm()) {
      counts[i] = false;
      continue;
    }
    amplitudes[i] = along / expected.squaredNorm();
    std::size_t place = count++;
    for (; place > 0 && sorted[place - 1] < amplitudes[i]; --place)
      sorted[place] = sorted[place - 1];
    sorted[place] = amplitudes[i];
  }
  if (count == 0) return static_cast<int>(before);
  // With an even number the larger one of the two in the middle: a faded pair is no measure.
  const double median = sorted[(count - 1) / 2];
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (counts[i] && amplitudes[i] < settings.least_amplitude * median) counts[i] = false;
  }
  return static_cast<int>(before - std::count(counts.begin(), counts.end(), true));
}

void PoseAligner::State::finish(AlignedPose& result) const {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double misfit = 0.0;
  int count = 0;
  const double floor_m2 = std::pow(settings.floor_px * m_per_px, 2);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    AlignedDisc& disc = result.discs[i];
    disc = {};
    disc.counts = counts[i];
    if (!counts[i]) continue;
    const Eigen::Matrix<double, 2, 3> a = lever(i);
    const Eigen::Matrix2d own_m2 = evidence[i].information.inverse();
    const Eigen::Matrix2d covariance_m2 =
        own_m2 * inflation[i] + (floor_m2 + shading_m2[i]) * Eigen::Matrix2d::Identity();
    information += a.transpose() * covariance_m2.inverse() * a;
    const Eigen::Vector2d off_m = own_m2 * evidence[i].gradient - a * last_step;
    misfit += off_m.dot(covariance_m2.inverse() * off_m);
    ++count;
    for (std::size_t c = 0; c < 3; ++c) {
      disc.level[static_cast<Eigen::Index>(c)] = discs[i].levels[c].level;
      disc.contrast[static_cast<Eigen::Index>(c)] = discs[i].levels[c].contrast;
    }
    disc.pixels = discs[i].pixels_in_disc();
    disc.chi_square_per_dof = inflation[i];
  }
  const double dof = 2.0 * count - 3.0;
  result.misfit = misfit / dof;
  result.covariance =
      information.inverse() * std::max(1.0, (misfit + kMisfitPrior_dof) / (dof + kMisfitPrior_dof));
  result.pose_world_robot = pose;
  result.counting_discs = count;
  result.uneven_light = false;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    result.uneven_light = result.uneven_light || (counts[i] && shading_m2[i] > 0.0);
  }
}

PoseAligner::PoseAligner(const vision::MarkerLayout& layout, const PlaneGrid& grid,
                         const AlignmentSettings& settings)
    : state_(std::make_unique<State>(layout, grid, settings)) {}
PoseAligner::~PoseAligner() = default;
PoseAligner::PoseAligner(PoseAligner&&) noexcept = default;
PoseAligner& PoseAligner::operator=(PoseAligner&&) noexcept = default;

const DiscTemplate& PoseAligner::robot() const { return state_->robot; }

bool PoseAligner::align(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor,
                        const PoseGuess& guess, const ExpectedLook* look,
                        std::span<const Obstacle> obstacles, AlignedPose& result) {
  State& s = *state_;
  s.pose = guess.pose_world_robot;
  s.blur_px = sensor.blur_px();
  s.inflation.fill(1.0);
  // Of a robot that is followed the first step is mostly the last but one.
  s.last_step_px = look != nullptr ? 0.9 * kNear_px : kNoLimit;
  s.structure.fill(1.0);
  s.shading_m2.fill(0.0);
  vision::PixelPoint centre_px = guess.centre_px;
  const double farthest_m = kFarthest_radii * s.robot.radius_m[0];
  bool gather_first = true;
  int covered = 0;
  for (result.iterations = 1; result.iterations <= kMostIterations; ++result.iterations) {
    const Eigen::Vector3d moved = fusion::pose_difference(s.pose, s.gathered_at);
    const double moved_px =
        (moved.head<2>().norm() + s.robot.reach_m * std::abs(moved.z())) / s.m_per_px;
    if (gather_first || moved_px > kGatherAgain_px) {
      const auto pixel = s.grid->pixel_near(s.pose.position_m(), centre_px);
      if (!pixel) return false;
      centre_px = *pixel;
      s.m_per_px = s.grid->metres_per_pixel(centre_px);
      if (!s.gather_discs(image, mosaic, sensor.light, obstacles, centre_px)) return false;
      for (std::size_t i = 0; i < s.discs.size(); ++i) {
        if (s.counts[i]) s.discs[i].start(s.edge(i), s.disc_centre_m(i));
      }
      gather_first = false;
      covered = 0;
    }
    s.evaluate_discs(sensor.noise());
    covered += s.judge_looks(look);
    if (covered > kMostCovered) return false;
    const bool near = s.last_step_px < kNear_px;
    if (near) s.look_at_structure(sensor.noise());
    if (std::count(s.counts.begin(), s.counts.begin() + s.robot.disc_count, true) < 2) return false;
    if (!s.step()) return false;
    const Eigen::Vector3d away = fusion::pose_difference(s.pose, guess.pose_world_robot);
    if (away.head<2>().norm() > farthest_m || std::abs(away.z()) > kFarthest_rad) return false;
    if (near && s.last_step_px < kSettled_px) break;
  }
  if (result.iterations > kMostIterations) return false;
  s.finish(result);
  const auto pixel = s.grid->pixel_near(s.pose.position_m(), centre_px);
  if (!pixel) return false;
  result.centre_px = *pixel;
  return true;
}

// The slope of the residuals well inside of a disc is that of the light.
void PoseAligner::State::teach_light(LightShape& light, const DiscState& disc,
                                     const ChannelLevels& levels, const ChannelScatter& scatter,
                                     const PixelNoise& noise) const {
  const auto n = static_cast<double>(scatter.inside_count);
  const double level = levels.level + levels.contrast;
  if (n < kLeastInside || level < kLeastLevel) return;
  const Eigen::Vector2d mean =
      Eigen::Vector2d(static_cast<double>(scatter.du), static_cast<double>(scatter.dv)) / n;
  const Eigen::Vector2d squares =
      Eigen::Vector2d(static_cast<double>(scatter.uu), static_cast<double>(scatter.vv)) -
      n * mean.cwiseAbs2();
  const Eigen::Vector2d moment =
      Eigen::Vector2d(static_cast<double>(scatter.ru), static_cast<double>(scatter.rv)) -
      mean * static_cast<double>(scatter.r);
  if (!(squares.minCoeff() > 1.0)) return;
  const vision::PixelPoint place = disc.patch.origin_px + mean;
  const Eigen::Vector2d slope = moment.cwiseQuotient(squares) / level;
  light.learn(place, slope + light.slope_per_px(place),
              noise.variance(level) / (squares.mean() * level * level));
}

void PoseAligner::teach(SensorModel& sensor) {
  State& s = *state_;
  const std::size_t i = s.taught_disc++ % s.discs.size();
  if (!s.counts[i]) return;
  // Uneven light tells nothing of optics, but a blur that is not known yet looks like it.
  const bool even = s.structure[i] <= kNoShadow && s.shading_m2[i] == 0.0;
  const bool knows_blur = sensor.blur_deviation_px() < kKnownBlur_px;
  DiscState& disc = s.discs[i];
  const OutlierLimits limits{s.settings.huber_sigmas, s.settings.far_sigmas};
  double score = 0.0;
  double information = 0.0;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const ChannelLevels& levels = disc.levels[channel];
    const ChannelSums sums =
        sum_channel(disc.patch, disc.shares, c, levels, disc.base(c), sensor.noise(), limits);
    const ChannelScatter scatter =
        scatter_of(disc.patch, disc.shares, c, levels, disc.base(c), sensor.noise(), limits);
    const auto d = [](float value) { return static_cast<double>(value); };
    if (scatter.inside_count > 1.0F) {
      sensor.learn_noise(levels.level + levels.contrast,
                         d(scatter.inside_squares) / (d(scatter.inside_count) - 0.5),
                         d(scatter.inside_count));
    }
    if (scatter.outside_count > 1.0F) {
      sensor.learn_noise(levels.level,
                         d(scatter.outside_squares) / (d(scatter.outside_count) - 0.5),
                         d(scatter.outside_count));
    }
    if (even) s.teach_light(sensor.light, disc, levels, scatter, sensor.noise());
    Eigen::Matrix2d aa;
    aa << d(sums.n), d(sums.s), d(sums.s), d(sums.ss);
    if (!(aa.determinant() > 1e-4 * aa(0, 0) * aa(0, 0))) continue;
    const Eigen::Vector2d ab(d(scatter.b), d(scatter.sb));
    const Eigen::Vector2d ar(d(sums.r), d(sums.sr));
    const Eigen::Vector2d gain = aa.inverse() * ab;
    score += levels.contrast * (d(scatter.br) - gain.dot(ar));
    information += levels.contrast * levels.contrast * (d(scatter.bb) - gain.dot(ab));
  }
  if (even || !knows_blur) sensor.learn_blur(score / s.inflation[i], information / s.inflation[i]);
}

}  // namespace nadir::tracker
