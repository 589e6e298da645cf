#include "calibration/diagnosis/residual_places.h"

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <numeric>

namespace nadir::calibration {
namespace {

/// Eigenvalues of as many points take some hundredths of a second; more points are averaged in as
/// many neighbourhoods.
constexpr std::size_t kMostPlaces = 128;
/// Smallest pivot of a design against its largest.
constexpr double kRankThreshold = 1e-8;

/// The points that stand farthest from all those before, one after the other: an even selection.
std::vector<std::size_t> farthest_points(const std::vector<vision::PixelPoint>& pixels,
                                         std::size_t count) {
  std::vector<double> distance2(pixels.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen = {0};
  while (chosen.size() < count) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      distance2[i] = std::min(distance2[i], (pixels[i] - pixels[chosen.back()]).squaredNorm());
    }
    chosen.push_back(static_cast<std::size_t>(std::max_element(distance2.begin(), distance2.end()) -
                                              distance2.begin()));
  }
  return chosen;
}

/// For each point the number of its neighbourhood: every point's own, or the nearest of an even
/// selection.
std::vector<std::size_t> neighbourhoods(const std::vector<vision::PixelPoint>& pixels) {
  std::vector<std::size_t> number(pixels.size());
  std::iota(number.begin(), number.end(), std::size_t{0});
  if (pixels.size() <= kMostPlaces) return number;
  const std::vector<std::size_t> centres = farthest_points(pixels, kMostPlaces);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    double least2 = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < centres.size(); ++c) {
      const double distance2 = (pixels[i] - pixels[centres[c]]).squaredNorm();
      if (distance2 >= least2) continue;
      least2 = distance2;
      number[i] = c;
    }
  }
  return number;
}

}  // namespace

Places places_of(const FitResiduals& fit) {
  const std::vector<std::size_t> number = neighbourhoods(fit.pixels);
  const std::size_t count = std::min(fit.pixels.size(), kMostPlaces);
  const Eigen::Index terms = fit.basis(fit.pixels.front()).rows();
  const auto rows = static_cast<Eigen::Index>(count);
  Places places;
  places.pixels.assign(count, vision::PixelPoint::Zero());
  places.error_m.setZero(rows, 2);
  for (Eigen::MatrixXd& design : places.design) design.setZero(rows, terms);
  Eigen::VectorXd points = Eigen::VectorXd::Zero(rows);
  for (std::size_t i = 0; i < fit.pixels.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(number[i]);
    const Eigen::RowVector2d scale = fit.noise_scale(fit.pixels[i]);
    const Eigen::MatrixX2d phi = fit.basis(fit.pixels[i]).array().rowwise() / scale.array();
    places.pixels[number[i]] += fit.pixels[i];
    places.error_m.row(row) += fit.error_m.row(static_cast<Eigen::Index>(i)).cwiseQuotient(scale);
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      places.design[static_cast<std::size_t>(axis)].row(row) += phi.col(axis);
    }
    points[row] += 1.0;
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    places.pixels[static_cast<std::size_t>(row)] /= points[row];
    places.error_m.row(row) /= points[row];
    for (Eigen::MatrixXd& design : places.design) design.row(row) /= points[row];
  }
  places.noise_share = points.cwiseInverse().mean();
  return places;
}

Eigen::MatrixXd contrast_basis(const Eigen::MatrixXd& design) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design.rows(), design.cols());
  qr.setThreshold(kRankThreshold);
  qr.compute(design);
  const Eigen::MatrixXd q = qr.householderQ();
  return q.rightCols(design.rows() - qr.rank());
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& design) {
  const Eigen::VectorXd norms = design.colwise().norm().cwiseMax(1e-300);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(design.rows(),
                                                                        design.cols());
  decomposition.setThreshold(kRankThreshold);
  decomposition.compute(design * norms.cwiseInverse().asDiagonal());
  return norms.cwiseInverse().asDiagonal() * decomposition.pseudoInverse();
}

}  // namespace nadir::calibration
