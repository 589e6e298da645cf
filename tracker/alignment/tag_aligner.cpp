#include "tracker/alignment/tag_aligner.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "tracker/alignment/tag_fit.h"

namespace nadir::tracker {
namespace {

constexpr int kMostIterations = 8;
constexpr int kFirstStride = 4;       // a quarter of the pixels is good enough for the first step
constexpr double kSettled_px = 0.03;  // the step after this one would be smaller than any error
constexpr double kFarthest_cells = 1.2;  // from the guess
constexpr double kFarthest_rad = 0.2;
constexpr double kLeastPixels = 60.0;
// Noise is each pixel's own; what else disturbs them (motion, a wrong gamma) depends on how far an
// edge runs from a pixel's middle. Along an edge that changes by the edge's slope from one pixel to
// the next: so many err together, the most where the print lies along the rows.
constexpr double kFewestErrTogether = 3.0;
constexpr double kMostErrTogether = 10.0;
constexpr double kAlike_px = 0.5;  // change of that distance between two that err together
constexpr double kMostBlurInformation = 5e4;  // of one tag, 1 / px^2

using Step = Eigen::Matrix<double, kTagSteps, 1>;
using StepInformation = Eigen::Matrix<double, kTagSteps, kTagSteps>;

// What one segment says of a step of TagSums, with black and contrast eliminated.
struct Evidence {
  StepInformation information = StepInformation::Zero();
  Step gradient = Step::Zero();
  Eigen::Matrix<double, 2, kTagSteps> levels_by_step;
  Eigen::Vector2d levels_step;
  double residual = 0.0;  // weighted squares, levels at their best
};

Evidence evidence_of(const TagSums& sums) {
  Evidence result;
  Eigen::Matrix2d levels;
  levels << sums.n, sums.t, sums.t, sums.tt;
  const Eigen::Vector2d levels_gradient(sums.r, sums.tr);
  Eigen::Matrix<double, 2, kTagSteps> mixed;
  std::size_t pair = 0;
  for (int k = 0; k < kTagSteps; ++k) {
    const auto i = static_cast<std::size_t>(k);
    mixed.col(k) << sums.d[i], sums.td[i];
    result.gradient[k] = static_cast<double>(sums.rd[i]);
    for (int m = k; m < kTagSteps; ++m) {
      result.information(k, m) = result.information(m, k) = static_cast<double>(sums.dd[pair++]);
    }
  }
  const Eigen::Matrix2d inverse = levels.inverse();
  result.levels_by_step = inverse * mixed;
  result.levels_step = inverse * levels_gradient;
  result.information -= mixed.transpose() * result.levels_by_step;
  result.gradient -= mixed.transpose() * result.levels_step;
  result.residual = static_cast<double>(sums.rr) - levels_gradient.dot(result.levels_step);
  return result;
}

}  // namespace

struct TagAligner::State {
  State(const vision::TagLayout& tags, const PlaneGrid& plane_grid,
        const TagAlignmentSettings& alignment_settings)
      : layout(tags), grid(&plane_grid), settings(alignment_settings) {}

  const TagTemplate& print_of(int tag_id);
  bool prepare(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor,
               const fusion::PlanarPose& guess, const vision::PixelPoint& middle_px);
  bool step();
  void move(const Step& change);
  bool finish(AlignedTag& result);
  double pixels_that_err_together(const LocalPlane& plane) const;
  TagPlace place() const;

  vision::TagLayout layout;
  const PlaneGrid* grid;
  TagAlignmentSettings settings;
  std::map<int, TagTemplate> prints;
  vision::PixelFetch meanwhile;
  TagPatch patch;
  const TagTemplate* print = nullptr;
  TagWeights weights;
  std::array<TagLevels, 3> levels;
  fusion::PlanarPose pose;
  fusion::PlanarPose guess;
  double left = 1.0;
  double cell_px = 0.0;
  double cell_m = 0.0;
  double err_together = kFewestErrTogether;
  double last_step_px = 0.0;
  Eigen::Matrix3d covariance;  // of the pose's part of a step
  double edges = 0.0;          // information of both shifts
  double pull = 0.0;
  double residual = 0.0;
  double pixels = 0.0;
  double value_variance = 0.0;
  double residual_variance = 0.0;
};

const TagTemplate& TagAligner::State::print_of(int tag_id) {
  const auto known = prints.find(tag_id);
  if (known != prints.end()) return known->second;
  return prints.emplace(tag_id, TagTemplate(vision::tag_pattern(layout.family, tag_id)))
      .first->second;
}

double TagAligner::State::pixels_that_err_together(const LocalPlane& plane) const {
  const Eigen::Vector2d axis(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  const Eigen::Vector2d edge_px = (plane.slope.inverse() * axis).cwiseAbs();
  const double slope = edge_px.minCoeff() / edge_px.maxCoeff();
  return std::clamp(kAlike_px / std::max(slope, 1e-6), kFewestErrTogether, kMostErrTogether);
}

TagPlace TagAligner::State::place() const {
  return {static_cast<float>(pose.x_m - guess.x_m),
          static_cast<float>(pose.y_m - guess.y_m),
          static_cast<float>(std::cos(pose.heading_rad)),
          static_cast<float>(std::sin(pose.heading_rad)),
          static_cast<float>(cell_m),
          static_cast<float>(left)};
}

bool TagAligner::State::prepare(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor,
                                const fusion::PlanarPose& first,
                                const vision::PixelPoint& middle_px) {
  guess = first;
  pose = first;
  cell_m = layout.size_m / layout.facts().square_cells;
  const LocalPlane plane = grid->about(static_cast<int>(std::lround(middle_px.x())),
                                       static_cast<int>(std::lround(middle_px.y())));
  const double determinant = plane.slope.determinant();
  // v runs down: a plane whose axes turn left seen from above is mirrored against the image.
  left = determinant < 0.0 ? 1.0 : -1.0;
  cell_px = cell_m / std::sqrt(std::abs(determinant));
  err_together = pixels_that_err_together(plane);
  weights.blur_cells = static_cast<float>(sensor.blur_px() / cell_px);
  weights.margin_cells = static_cast<float>(settings.margin_sigmas) * weights.blur_cells;
  weights.noise = sensor.noise();
  weights.huber_sigmas = static_cast<float>(settings.huber_sigmas);
  weights.stride = kFirstStride;
  const double reach_m = 0.5 * cell_m * layout.facts().cells;
  const bool seen = gather_tag(image, mosaic, *grid, first, middle_px, reach_m, meanwhile, patch);
  meanwhile.all_rows();
  if (!seen) return false;
  for (int segment = 0; segment < patch.segments; ++segment) {
    TagLevels& level = levels[static_cast<std::size_t>(segment)];
    level = fit_tag_levels(patch, segment, *print, place(), weights);
    if (!(level.contrast > 0.0F)) return false;
  }
  return true;
}

bool TagAligner::State::step() {
  StepInformation all = StepInformation::Zero();
  Step gradient = Step::Zero();
  std::array<Evidence, 3> evidence;
  pull = residual = pixels = value_variance = residual_variance = 0.0;
  for (int segment = 0; segment < patch.segments; ++segment) {
    const auto c = static_cast<std::size_t>(segment);
    const TagSums sums = sum_tag(patch, segment, *print, place(), levels[c], weights);
    const auto count = static_cast<double>(sums.pixels);
    if (count * patch.segments * weights.stride < kLeastPixels) return false;
    evidence[c] = evidence_of(sums);
    all += evidence[c].information;
    gradient += evidence[c].gradient;
    residual += evidence[c].residual;
    pixels += count;
    pull += static_cast<double>(sums.pull);
    const double mean = static_cast<double>(sums.value_sum) / count;
    value_variance += static_cast<double>(sums.value_squares) - mean * mean * count;
    residual_variance += static_cast<double>(sums.residual_squares);
  }
  const Eigen::LDLT<StepInformation> solver(all);
  if (!solver.isPositive() || !(solver.vectorD().minCoeff() > 0.0)) return false;
  const Step change = solver.solve(gradient);
  covariance = solver.solve(StepInformation::Identity()).topLeftCorner<3, 3>();
  edges = all(0, 0) + all(1, 1);
  for (int segment = 0; segment < patch.segments; ++segment) {
    const auto c = static_cast<std::size_t>(segment);
    const Eigen::Vector2d levels_change =
        evidence[c].levels_step - evidence[c].levels_by_step * change;
    levels[c].black += static_cast<float>(levels_change[0]);
    levels[c].contrast += static_cast<float>(levels_change[1]);
    levels[c].rise_a += static_cast<float>(change[3]);
    levels[c].rise_b += static_cast<float>(change[4]);
    if (!(levels[c].contrast > 0.0F)) return false;
  }
  move(change);
  return true;
}

void TagAligner::State::move(const Step& change) {
  const double cosine = std::cos(pose.heading_rad);
  const double sine = std::sin(pose.heading_rad);
  // Down the print's columns is to the right of its rows, seen from above.
  pose.x_m += cell_m * (cosine * change[0] + left * sine * change[1]);
  pose.y_m += cell_m * (sine * change[0] - left * cosine * change[1]);
  pose.heading_rad = fusion::wrap_angle(pose.heading_rad + change[2]);
  const double half_square = 0.5 * layout.facts().square_cells;
  last_step_px = cell_px * std::max(change.head<2>().norm(), half_square * std::abs(change[2]));
}

bool TagAligner::State::finish(AlignedTag& result) {
  result.explained = 1.0 - residual_variance / std::max(value_variance, 1e-9);
  if (result.explained < settings.least_explained) return false;
  result.pose_world_tag = pose;
  result.contrast = 0.0;
  for (int segment = 0; segment < patch.segments; ++segment) {
    result.contrast += static_cast<double>(levels[static_cast<std::size_t>(segment)].contrast);
  }
  result.contrast /= 3.0;
  // Residuals near edges tell of what disturbs the pose, those of the whole print of the light.
  const double by_edges = pull / edges;
  result.chi_square_per_dof = residual / std::max(1.0, pixels - kTagSteps - 2.0 * patch.segments);
  // Not what is chance; a third of the pixels lies at edges.
  const double chance = 2.0 * std::sqrt(6.0 / pixels);
  const double excess =
      std::max({0.0, by_edges - 1.0 - chance, result.chi_square_per_dof - 1.0 - chance});
  const double inflation = 1.0 + err_together * excess;
  const double cosine = std::cos(pose.heading_rad);
  const double sine = std::sin(pose.heading_rad);
  Eigen::Matrix3d world_from_step = Eigen::Matrix3d::Identity();
  world_from_step.topLeftCorner<2, 2>() << cosine, left * sine, sine, -left * cosine;
  world_from_step.topLeftCorner<2, 2>() *= cell_m;
  result.covariance = inflation * world_from_step * covariance * world_from_step.transpose();
  const double m_per_px = cell_m / cell_px;
  const double floor_m = std::hypot(settings.floor_px * m_per_px, settings.floor_cells * cell_m);
  // The heading's floor: what the middle's makes of it over the print.
  const double lever_m = 0.5 * layout.size_m;
  result.covariance(0, 0) += floor_m * floor_m;
  result.covariance(1, 1) += floor_m * floor_m;
  result.covariance(2, 2) += std::pow(floor_m / lever_m, 2) / 2.0;
  return true;
}

TagAligner::TagAligner(const vision::TagLayout& layout, const PlaneGrid& grid,
                       const TagAlignmentSettings& settings)
    : state_(std::make_unique<State>(layout, grid, settings)) {}
TagAligner::~TagAligner() = default;
TagAligner::TagAligner(TagAligner&&) noexcept = default;
TagAligner& TagAligner::operator=(TagAligner&&) noexcept = default;

void TagAligner::fetch_meanwhile(const vision::PixelFetch& next) { state_->meanwhile = next; }

bool TagAligner::align(const cv::Mat& image, Mosaic mosaic, const SensorModel& sensor, int tag_id,
                       const fusion::PlanarPose& guess, const vision::PixelPoint& middle_px,
                       AlignedTag& result) {
  State& s = *state_;
  s.print = &s.print_of(tag_id);
  if (!s.prepare(image, mosaic, sensor, guess, middle_px)) return false;
  for (result.iterations = 1; result.iterations <= kMostIterations; ++result.iterations) {
    if (!s.step()) return false;
    const double moved_m = (s.pose.position_m() - guess.position_m()).norm();
    const double turned_rad = std::abs(fusion::wrap_angle(s.pose.heading_rad - guess.heading_rad));
    if (!(moved_m < kFarthest_cells * s.cell_m) || !(turned_rad < kFarthest_rad)) return false;
    if (s.weights.stride == 1 && s.last_step_px < kSettled_px) return s.finish(result);
    s.weights.stride = 1;
  }
  return false;
}

void TagAligner::teach(SensorModel& sensor) {
  State& s = *state_;
  double score = 0.0;
  double information = 0.0;
  for (int segment = 0; segment < s.patch.segments; ++segment) {
    const auto c = static_cast<std::size_t>(segment);
    const TagLevels& level = s.levels[c];
    const TagScatter scatter = scatter_tag(s.patch, segment, *s.print, s.place(), level, s.weights);
    if (scatter.black_count > 20.0F) {
      sensor.learn_noise(static_cast<double>(level.black),
                         static_cast<double>(scatter.black_squares / scatter.black_count),
                         static_cast<double>(scatter.black_count));
    }
    if (scatter.white_count > 20.0F) {
      sensor.learn_noise(static_cast<double>(level.black + level.contrast),
                         static_cast<double>(scatter.white_squares / scatter.white_count),
                         static_cast<double>(scatter.white_count));
    }
    // The part of the blur's derivative that black and contrast do not explain.
    Eigen::Matrix2d levels;
    levels << scatter.n, scatter.t, scatter.t, scatter.tt;
    const Eigen::Vector2d mixed(scatter.s, scatter.st);
    const double per_px = static_cast<double>(level.contrast) / s.cell_px;
    score += per_px * static_cast<double>(scatter.sr);
    information +=
        per_px * per_px * (static_cast<double>(scatter.ss) - mixed.dot(levels.inverse() * mixed));
  }
  // One tag may say more than the model keeps in all: a share of it, or its steps would be too
  // long.
  const double share = std::min(1.0, kMostBlurInformation / std::max(information, 1.0));
  sensor.learn_blur(share * score, share * information);
}

}  // namespace nadir::tracker
