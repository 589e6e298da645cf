#include "calibration/residual_field.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace nadir::calibration {
namespace {

constexpr int kColumns = 13;
constexpr int kRows = 10;
/// Eigenvalues of as many points take a fraction of a second; of more points an even selection is
/// taken.
constexpr Eigen::Index kMostPoints = 200;
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
  Eigen::MatrixX2d contrasts;
};

struct Hypothesis {
  std::size_t model = 0;
  double field_m2 = 0.0;
  double noise_m2 = 0.0;
  double weight = 0.0;  ///< first the logarithm of its likelihood
};

using Hypotheses = std::array<std::vector<Hypothesis>, 2>;  // per axis

/// Matern 5/2 with variance 1.
double correlation(double distance_px, double length_px) {
  const double t = std::sqrt(5.0) * distance_px / length_px;
  return (1.0 + t + t * t / 3.0) * std::exp(-t);
}

FitResiduals thinned(const FitResiduals& fit) {
  const Eigen::Index count = fit.error_m.rows();
  if (count <= kMostPoints) return fit;
  FitResiduals few{fit.box, {}, Eigen::MatrixX2d(kMostPoints, 2), fit.basis};
  for (Eigen::Index i = 0; i < kMostPoints; ++i) {
    const Eigen::Index from = i * count / kMostPoints;
    few.pixels.push_back(fit.pixels[static_cast<std::size_t>(from)]);
    few.error_m.row(i) = fit.error_m.row(from);
  }
  return few;
}

/// Phi: a row of basis functions a point.
Eigen::MatrixXd design_matrix(const FitResiduals& fit) {
  Eigen::MatrixXd design(fit.error_m.rows(), fit.basis(fit.pixels.front()).size());
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    design.row(i) = fit.basis(fit.pixels[static_cast<std::size_t>(i)]);
  }
  return design;
}

/// A: orthonormal columns, A^T design = 0.
Eigen::MatrixXd contrast_basis(const Eigen::MatrixXd& design) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design);
  const Eigen::MatrixXd q = qr.householderQ();
  return q.rightCols(design.rows() - design.cols());
}

std::vector<double> lengths_px(const FitResiduals& fit) {
  const Eigen::Vector2d extent_px = fit.box.high_px - fit.box.low_px;
  const double spacing_px = std::sqrt(extent_px.prod() / static_cast<double>(fit.pixels.size()));
  const double longest_px = kLongestOfExtent * extent_px.maxCoeff();
  std::vector<double> lengths;
  for (double length = kShortestOfSpacing * spacing_px; length < longest_px; length *= kLengthStep)
    lengths.push_back(length);
  return lengths;
}

FieldModel field_model(const FitResiduals& fit, const Eigen::MatrixXd& contrasts,
                       double length_px) {
  const Eigen::Index count = contrasts.rows();
  FieldModel model;
  model.length_px = length_px;
  model.covariance.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double distance_px =
          (fit.pixels[static_cast<std::size_t>(i)] - fit.pixels[static_cast<std::size_t>(j)])
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
  model.contrasts = model.directions * fit.error_m;
  return model;
}

/// Of one axis's contrasts, up to a constant (restricted likelihood: the polynomial is left out).
double log_likelihood(const FieldModel& model, int axis, double field_m2, double noise_m2) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < model.eigenvalues.size(); ++i) {
    const double variance_m2 = field_m2 * model.eigenvalues[i] + noise_m2;
    const double z_m = model.contrasts(i, axis);
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

/// Those of one axis. `residual_m2` is the residuals' variance, above 0.
std::vector<Hypothesis> weigh(const std::vector<FieldModel>& models, int axis, double residual_m2,
                              const std::optional<Eigen::Vector2d>& stated_m2) {
  std::vector<double> noises_m2;
  const double least_m2 = std::ldexp(residual_m2, 2 * kWeakestNoise);
  if (stated_m2) {
    noises_m2.push_back(std::max((*stated_m2)[axis], least_m2));
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
            {model, field_m2, noise_m2, log_likelihood(models[model], axis, field_m2, noise_m2)});
      }
    }
  }
  normalise(&hypotheses);
  return hypotheses;
}

/// Residuals, what may explain them, and with which weight.
class ResidualField {
 public:
  ResidualField(const FitResiduals& all, const std::optional<Eigen::Vector2d>& stated_m2)
      : fit_(thinned(all)), design_(design_matrix(fit_)) {
    const Eigen::MatrixXd contrasts = contrast_basis(design_);
    const Eigen::MatrixX2d z_m = contrasts.transpose() * fit_.error_m;
    for (const double length : lengths_px(fit_)) {
      models_.push_back(field_model(fit_, contrasts, length));
    }
    for (int axis = 0; axis < 2; ++axis) {
      // Points without any error leave a variance of 0, whose logarithm nobody wants.
      const double residual_m2 = std::max(z_m.col(axis).squaredNorm() / z_m.rows(), kLeast_m2);
      hypotheses_[axis] = weigh(models_, axis, residual_m2, stated_m2);
    }
    normal_.compute(design_.transpose() * design_);
    shift_m_ = normal_.solve(design_.transpose() * fit_.error_m);
  }

  /// Averaged over the hypotheses, per axis.
  Eigen::Vector2d noise_variance_m2() const {
    Eigen::Vector2d noise_m2 = Eigen::Vector2d::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      for (const Hypothesis& one : hypotheses_[axis]) noise_m2[axis] += one.weight * one.noise_m2;
    }
    return noise_m2;
  }

  /// E[d | z] and the variance of its part from the field, averaged over the hypotheses.
  LackOfFitNode at(const vision::PixelPoint& pixel) const {
    const Eigen::VectorXd phi = fit_.basis(pixel);
    const Eigen::VectorXd a = design_ * normal_.solve(phi);
    Moments moments;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      if (is_used(index)) add_moments(index, pixel, a, &moments);
    }
    return {moments.first_m + shift_m_.transpose() * phi,
            (moments.second_m2 - moments.first_m.cwiseAbs2()).cwiseMax(0.0)};
  }

 private:
  struct Moments {
    Eigen::Vector2d first_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d second_m2 = Eigen::Vector2d::Zero();
  };

  bool is_used(std::size_t model) const {
    const auto holds = [model](const std::vector<Hypothesis>& hypotheses) {
      return std::any_of(hypotheses.begin(), hypotheses.end(),
                         [model](const Hypothesis& one) { return one.model == model; });
    };
    return holds(hypotheses_[0]) || holds(hypotheses_[1]);
  }

  void add_moments(std::size_t index, const vision::PixelPoint& pixel, const Eigen::VectorXd& a,
                   Moments* moments) const {
    const FieldModel& model = models_[index];
    Eigen::VectorXd k(a.size());
    for (Eigen::Index i = 0; i < k.size(); ++i) {
      const double distance_px = (fit_.pixels[static_cast<std::size_t>(i)] - pixel).norm();
      k[i] = model.norm * correlation(distance_px, model.length_px);
    }
    const Eigen::VectorXd spread = model.covariance * a;
    const Eigen::VectorXd shared = model.directions * (k - spread);  // of d and z
    const double prior = model.norm - 2.0 * a.dot(k) + a.dot(spread);
    for (int axis = 0; axis < 2; ++axis) {
      for (const Hypothesis& one : hypotheses_[axis]) {
        if (one.model != index) continue;
        const Eigen::VectorXd gain = one.field_m2 * shared.array() /
                                     (one.field_m2 * model.eigenvalues.array() + one.noise_m2);
        const double mean_m = gain.dot(model.contrasts.col(axis));
        const double variance_m2 = one.field_m2 * std::max(0.0, prior - gain.dot(shared));
        moments->first_m[axis] += one.weight * mean_m;
        moments->second_m2[axis] += one.weight * (mean_m * mean_m + variance_m2);
      }
    }
  }

  FitResiduals fit_;
  Eigen::MatrixXd design_;
  std::vector<FieldModel> models_;
  Hypotheses hypotheses_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  /// What the fit would move without the points that were left out; else zero.
  Eigen::MatrixX2d shift_m_;
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
  std::vector<LackOfFitNode> nodes;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      nodes.push_back(field.at(grid_pixel(fit.box, column, row)));
    }
  }
  add_grid_error(fit.box, field, &nodes);
  const Eigen::Vector2d noise_m2 = stated_variance_m2.value_or(field.noise_variance_m2());
  if (!stated_variance_m2) {
    for (LackOfFitNode& node : nodes) node.variance_m2 += noise_m2;
  }
  return {LackOfFit(fit.box, kColumns, kRows, std::move(nodes)), noise_m2};
}

}  // namespace nadir::calibration
