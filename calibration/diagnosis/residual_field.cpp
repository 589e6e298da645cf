#include "calibration/diagnosis/residual_field.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "calibration/diagnosis/residual_places.h"

namespace nadir::calibration {
namespace {

/// Cells of the grid in the points' box, and beyond it on each side: near by, the field itself says
/// best how the model goes wrong there. The border of the box is one of nodes, so that what lies
/// beyond it does not reach into it.
constexpr int kInnerColumns = 12;
constexpr int kInnerRows = 9;
constexpr int kOuterColumns = 3;
constexpr int kOuterRows = 2;
constexpr int kColumns = kInnerColumns + 2 * kOuterColumns + 1;
constexpr int kRows = kInnerRows + 2 * kOuterRows + 1;
/// Lengths tried: from the points' spacing to far beyond the image, where a field is nearly one
/// more term of the polynomial.
constexpr double kShortestOfSpacing = 0.7;
constexpr double kLengthStep = 1.6;
constexpr double kLongestOfExtent = 2.0;
/// Variances tried, in steps of 4, against that of the residuals: of the field's share in them, and
/// of the noise where it is not stated. The lowest are as good as none.
constexpr int kWeakestField = -6;
constexpr int kStrongestField = 2;
constexpr int kWeakestNoise = -10;
/// Smallest variance of residuals that is told from none, (1e-15 m)^2.
constexpr double kLeast_m2 = 1e-30;
/// What is less likely than this share of all is left out.
constexpr double kLeastWeight = 1e-4;

/// A field of one length, with its contrasts in the directions in which they are independent.
struct FieldModel {
  double length_px = 0.0;
  double norm = 0.0;            ///< the field's variance where the contrasts' mean is 1
  Eigen::MatrixXd covariance;   ///< of the field at the points, n x n
  Eigen::MatrixXd directions;   ///< (n - terms) x n: rows from the points to the contrasts
  Eigen::VectorXd eigenvalues;  ///< of the contrasts' covariance, mean 1
  Eigen::VectorXd contrasts;
};

struct Hypothesis {
  std::size_t model = 0;
  double field_m2 = 0.0;
  double noise_m2 = 0.0;
  double weight = 0.0;  ///< first the logarithm of its likelihood
};

/// Matern 5/2 with variance 1.
double correlation(double distance_px, double length_px) {
  const double t = std::sqrt(5.0) * distance_px / length_px;
  return (1.0 + t + t * t / 3.0) * std::exp(-t);
}

std::vector<double> lengths_px(const PixelBox& box, std::size_t places) {
  const Eigen::Vector2d extent_px = box.high_px - box.low_px;
  const double spacing_px = std::sqrt(extent_px.prod() / static_cast<double>(places));
  const double longest_px = kLongestOfExtent * extent_px.maxCoeff();
  std::vector<double> lengths;
  for (double length = kShortestOfSpacing * spacing_px; length < longest_px; length *= kLengthStep)
    lengths.push_back(length);
  return lengths;
}

/// Of contrasts A (a column each); their values are not known yet.
FieldModel field_model(const Places& places, const Eigen::MatrixXd& contrasts, double length_px) {
  const Eigen::Index count = contrasts.rows();
  FieldModel model;
  model.length_px = length_px;
  model.covariance.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double distance_px =
          (places.pixels[static_cast<std::size_t>(i)] - places.pixels[static_cast<std::size_t>(j)])
              .norm();
      model.covariance(i, j) = model.covariance(j, i) = correlation(distance_px, length_px);
    }
  }
  const Eigen::MatrixXd reduced = contrasts.transpose() * model.covariance * contrasts;
  model.norm = static_cast<double>(reduced.rows()) / reduced.trace();
  model.covariance *= model.norm;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(model.norm * reduced);
  model.eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  model.directions = solver.eigenvectors().transpose() * contrasts.transpose();
  return model;
}

/// Of the contrasts, up to a constant (restricted likelihood: the parameters are left out).
double log_likelihood(const FieldModel& model, double field_m2, double noise_m2) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < model.eigenvalues.size(); ++i) {
    const double variance_m2 = field_m2 * model.eigenvalues[i] + noise_m2;
    const double z_m = model.contrasts[i];
    sum -= 0.5 * (std::log(variance_m2) + z_m * z_m / variance_m2);
  }
  return sum;
}

/// Likelihoods become weights of sum 1.
void normalise(std::vector<Hypothesis>* hypotheses) {
  double best = -std::numeric_limits<double>::infinity();
  for (const Hypothesis& one : *hypotheses) best = std::max(best, one.weight);
  double sum = 0.0;
  for (Hypothesis& one : *hypotheses) sum += one.weight = std::exp(one.weight - best);
  std::erase_if(*hypotheses,
                [&](const Hypothesis& one) { return one.weight < kLeastWeight * sum; });
  sum = 0.0;
  for (const Hypothesis& one : *hypotheses) sum += one.weight;
  for (Hypothesis& one : *hypotheses) one.weight /= sum;
}

/// `residual_m2` is the contrasts' mean square, above 0.
std::vector<Hypothesis> weigh(const std::vector<FieldModel>& models, double residual_m2,
                              const std::optional<double>& stated_m2) {
  std::vector<double> noises_m2;
  const double least_m2 = std::ldexp(residual_m2, 2 * kWeakestNoise);
  if (stated_m2) {
    noises_m2.push_back(std::max(*stated_m2, least_m2));
  } else {
    for (int k = kWeakestNoise; k <= 0; ++k) noises_m2.push_back(std::ldexp(residual_m2, 2 * k));
  }
  const double unit_m2 = std::max(residual_m2, noises_m2.front());
  std::vector<Hypothesis> hypotheses;
  for (std::size_t model = 0; model < models.size(); ++model) {
    for (const double noise_m2 : noises_m2) {
      for (int k = kWeakestField; k <= kStrongestField; ++k) {
        const double field_m2 = std::ldexp(unit_m2, 2 * k);
        hypotheses.push_back(
            {model, field_m2, noise_m2, log_likelihood(models[model], field_m2, noise_m2)});
      }
    }
  }
  normalise(&hypotheses);
  return hypotheses;
}

/// Mean and mean square of a place's error about the refitted map.
struct Moments {
  double first_m = 0.0;
  double second_m2 = 0.0;
};

/// One axis's residuals, what may explain them, and with which weight.
class AxisField {
 public:
  /// For errors of this design, which look_at tells.
  AxisField(const Places& places, const PixelBox& box, const Eigen::MatrixXd& design)
      : pixels_(places.pixels), noise_share_(places.noise_share), inverse_(pseudo_inverse(design)) {
    const Eigen::MatrixXd contrasts = contrast_basis(design);
    for (const double length : lengths_px(box, pixels_.size())) {
      models_.push_back(field_model(places, contrasts, length));
    }
  }

  void look_at(const Eigen::VectorXd& error_m, const std::optional<double>& stated_m2) {
    for (FieldModel& model : models_) model.contrasts = model.directions * error_m;
    // Points without any error leave a variance of 0, whose logarithm nobody wants.
    const Eigen::VectorXd& contrasts_m = models_.front().contrasts;
    const double residual_m2 =
        std::max(contrasts_m.squaredNorm() / static_cast<double>(contrasts_m.size()), kLeast_m2);
    std::optional<double> stated_here_m2;
    if (stated_m2) stated_here_m2 = *stated_m2 * noise_share_;
    hypotheses_ = weigh(models_, residual_m2, stated_here_m2);
    shift_m_ = inverse_ * error_m;
  }

  /// Of a point, averaged over the hypotheses.
  double noise_variance_m2() const {
    double noise_m2 = 0.0;
    for (const Hypothesis& one : hypotheses_) noise_m2 += one.weight * one.noise_m2;
    return noise_m2 / noise_share_;
  }

  /// E[d | z] and the variance of its part from the field, averaged over the hypotheses. `phi` is
  /// the axis's basis at the pixel.
  std::pair<double, double> at(const vision::PixelPoint& pixel, const Eigen::VectorXd& phi) const {
    const Eigen::VectorXd a = inverse_.transpose() * phi;
    Moments moments;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      if (is_used(index)) add_moments(index, pixel, a, &moments);
    }
    const double variance_m2 = std::max(0.0, moments.second_m2 - moments.first_m * moments.first_m);
    return {moments.first_m + shift_m_.dot(phi), variance_m2};
  }

 private:
  bool is_used(std::size_t model) const {
    return std::any_of(hypotheses_.begin(), hypotheses_.end(),
                       [model](const Hypothesis& one) { return one.model == model; });
  }

  void add_moments(std::size_t index, const vision::PixelPoint& pixel, const Eigen::VectorXd& a,
                   Moments* moments) const {
    const FieldModel& model = models_[index];
    Eigen::VectorXd k(a.size());
    for (Eigen::Index i = 0; i < k.size(); ++i) {
      const double distance_px = (pixels_[static_cast<std::size_t>(i)] - pixel).norm();
      k[i] = model.norm * correlation(distance_px, model.length_px);
    }
    const Eigen::VectorXd spread = model.covariance * a;
    const Eigen::VectorXd shared = model.directions * (k - spread);  // of d and z
    const double prior = model.norm - 2.0 * a.dot(k) + a.dot(spread);
    for (const Hypothesis& one : hypotheses_) {
      if (one.model != index) continue;
      const Eigen::VectorXd gain =
          one.field_m2 * shared.array() / (one.field_m2 * model.eigenvalues.array() + one.noise_m2);
      const double mean_m = gain.dot(model.contrasts);
      const double variance_m2 = one.field_m2 * std::max(0.0, prior - gain.dot(shared));
      moments->first_m += one.weight * mean_m;
      moments->second_m2 += one.weight * (mean_m * mean_m + variance_m2);
    }
  }

  std::vector<vision::PixelPoint> pixels_;
  double noise_share_;
  Eigen::MatrixXd inverse_;  ///< from errors to what they move the parameters
  std::vector<FieldModel> models_;
  std::vector<Hypothesis> hypotheses_;
  /// What the fit would move if each axis had its own parameters and neighbourhoods were points;
  /// else zero.
  Eigen::VectorXd shift_m_;
};

std::optional<double> of_axis(const std::optional<Eigen::Vector2d>& both, int axis) {
  return both ? std::optional<double>((*both)[axis]) : std::nullopt;
}

/// Both axes.
class ResidualField {
 public:
  ResidualField(const FitResiduals& fit, const std::optional<Eigen::Vector2d>& stated_m2)
      : ResidualField(fit, places_of(fit), stated_m2) {}

  Eigen::Vector2d noise_variance_m2() const {
    return {axes_[0].noise_variance_m2(), axes_[1].noise_variance_m2()};
  }

  LackOfFitNode at(const vision::PixelPoint& pixel) const {
    const Eigen::MatrixX2d phi = basis_(pixel);
    const Eigen::Vector2d scale = noise_scale_(pixel);
    const auto [x_m, x_m2] = axes_[0].at(pixel, phi.col(0) / scale.x());
    const auto [y_m, y_m2] = axes_[1].at(pixel, phi.col(1) / scale.y());
    return {scale.cwiseProduct(Eigen::Vector2d(x_m, y_m)),
            scale.cwiseAbs2().cwiseProduct(Eigen::Vector2d(x_m2, y_m2))};
  }

 private:
  ResidualField(const FitResiduals& fit, const Places& places,
                const std::optional<Eigen::Vector2d>& stated_m2)
      : basis_(fit.basis), noise_scale_(fit.noise_scale) {
    axes_.emplace_back(places, fit.box, places.design[0]);
    if (places.design[0] == places.design[1]) {  // the costly part is the same
      axes_.push_back(axes_.front());
    } else {
      axes_.emplace_back(places, fit.box, places.design[1]);
    }
    for (int axis = 0; axis < 2; ++axis) {
      axes_[static_cast<std::size_t>(axis)].look_at(places.error_m.col(axis),
                                                    of_axis(stated_m2, axis));
    }
  }

  std::function<Eigen::MatrixX2d(const vision::PixelPoint&)> basis_;
  std::function<Eigen::Vector2d(const vision::PixelPoint&)> noise_scale_;
  std::vector<AxisField> axes_;  ///< x, y
};

vision::PixelPoint grid_pixel(const PixelBox& box, double column, double row) {
  const Eigen::Vector2d share(column / (kColumns - 1), row / (kRows - 1));
  return box.low_px + share.cwiseProduct(box.high_px - box.low_px);
}

/// What straight lines between the nodes miss: the error of the grid in the middle of a cell,
/// squared, is shared among its corners, each of which takes the mean of its cells.
void add_grid_error(const PixelBox& box, const ResidualField& field,
                    std::vector<LackOfFitNode>* nodes) {
  std::vector<Eigen::Vector2d> sums_m2(nodes->size(), Eigen::Vector2d::Zero());
  std::vector<int> cells(nodes->size(), 0);
  for (int row = 0; row + 1 < kRows; ++row) {
    for (int column = 0; column + 1 < kColumns; ++column) {
      const auto first =
          static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
      const std::array<std::size_t, 4> corners = {first, first + 1, first + kColumns,
                                                  first + kColumns + 1};
      Eigen::Vector2d error_m = field.at(grid_pixel(box, column + 0.5, row + 0.5)).error_m;
      for (const std::size_t corner : corners) error_m -= 0.25 * (*nodes)[corner].error_m;
      for (const std::size_t corner : corners) {
        sums_m2[corner] += error_m.cwiseAbs2();
        ++cells[corner];
      }
    }
  }
  for (std::size_t i = 0; i < nodes->size(); ++i) (*nodes)[i].variance_m2 += sums_m2[i] / cells[i];
}

}  // namespace

ResidualEstimate estimate_residual_field(const FitResiduals& fit,
                                         const std::optional<Eigen::Vector2d>& stated_variance_m2) {
  const ResidualField field(fit, stated_variance_m2);
  const Eigen::Vector2d side_px = fit.box.high_px - fit.box.low_px;
  const Eigen::Vector2d margin_px(side_px.x() * kOuterColumns / kInnerColumns,
                                  side_px.y() * kOuterRows / kInnerRows);
  const PixelBox box{fit.box.low_px - margin_px, fit.box.high_px + margin_px};
  std::vector<LackOfFitNode> nodes;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      nodes.push_back(field.at(grid_pixel(box, column, row)));
    }
  }
  add_grid_error(box, field, &nodes);
  const Eigen::Vector2d noise_m2 = stated_variance_m2.value_or(field.noise_variance_m2());
  if (!stated_variance_m2) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto row = static_cast<int>(i) / kColumns;
      const auto column = static_cast<int>(i) % kColumns;
      const Eigen::Vector2d scale = fit.noise_scale(grid_pixel(box, column, row));
      nodes[i].variance_m2 += noise_m2.cwiseProduct(scale.cwiseAbs2());
    }
  }
  return {LackOfFit(box, kColumns, kRows, std::move(nodes)), noise_m2};
}

}  // namespace nadir::calibration
