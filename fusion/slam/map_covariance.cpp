#include "fusion/slam/map_covariance.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace nadir::fusion {
namespace {

// Compiled twice, for processors with and without AVX2; which one runs is decided at start-up. Not
// where the compiler cannot do it or where the address sanitizer starts too late for it. Multiply
// and add stay two roundings (-ffp-contract=off), so both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__)
#define NADIR_TWO_WIDTHS __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define NADIR_TWO_WIDTHS
#endif

// Two columns of P, which share what is read of four columns of the panel, `stride` apart:
//     p += a0 w0 + a1 w1 + a2 w2 + a3 w3,   q += a0 v0 + a1 v1 + a2 v2 + a3 v3
// element by element in this order, so that vectors of any width give the same bits.
NADIR_TWO_WIDTHS void add_four_to_two(double* __restrict p, double* __restrict q, Eigen::Index n,
                                      const double* __restrict a, Eigen::Index stride,
                                      const double* __restrict w, const double* __restrict v) {
  const double* __restrict a1 = a + stride;
  const double* __restrict a2 = a1 + stride;
  const double* __restrict a3 = a2 + stride;
  for (Eigen::Index i = 0; i < n; ++i) {
    p[i] = p[i] + (((a[i] * w[0] + a1[i] * w[1]) + a2[i] * w[2]) + a3[i] * w[3]);
    q[i] = q[i] + (((a[i] * v[0] + a1[i] * v[1]) + a2[i] * v[2]) + a3[i] * v[3]);
  }
}

// One column and four of the panel.
NADIR_TWO_WIDTHS void add_four(double* __restrict p, Eigen::Index n, const double* __restrict a,
                               Eigen::Index stride, const double* __restrict w) {
  const double* __restrict a1 = a + stride;
  const double* __restrict a2 = a1 + stride;
  const double* __restrict a3 = a2 + stride;
  for (Eigen::Index i = 0; i < n; ++i) {
    p[i] = p[i] + (((a[i] * w[0] + a1[i] * w[1]) + a2[i] * w[2]) + a3[i] * w[3]);
  }
}

// Two columns of P and two of the panel.
NADIR_TWO_WIDTHS void add_two_to_two(double* __restrict p, double* __restrict q, Eigen::Index n,
                                     const double* __restrict a, Eigen::Index stride,
                                     const double* __restrict w, const double* __restrict v) {
  const double* __restrict a1 = a + stride;
  for (Eigen::Index i = 0; i < n; ++i) {
    p[i] = p[i] + (a[i] * w[0] + a1[i] * w[1]);
    q[i] = q[i] + (a[i] * v[0] + a1[i] * v[1]);
  }
}

NADIR_TWO_WIDTHS void add_one(double* __restrict p, Eigen::Index n, const double* __restrict a,
                              double w) {
  for (Eigen::Index i = 0; i < n; ++i) p[i] = p[i] + a[i] * w;
}

}  // namespace

MapCovariance::MapCovariance(int head, int landmarks, int most_rank)
    : head_(head), capacity_(landmarks), most_rank_(most_rank) {
  const Eigen::Index n = head + 2 * landmarks;
  data_ = Eigen::MatrixXd::Zero(n, n + 1);
  transition_ = Eigen::MatrixXd::Identity(head, head);
  scratch_ = Eigen::MatrixXd::Zero(head, head);
  panel_ =
      Eigen::MatrixXd::Zero(n, std::max(head, most_rank + 2));  // also holds the head's columns
  weights_ = Eigen::MatrixXd::Zero(most_rank + 2, n + 1);
}

void MapCovariance::restart(const Eigen::Ref<const Eigen::MatrixXd>& head_covariance) {
  landmarks_ = 0;
  waits_ = false;
  transition_.setIdentity();
  data_.topLeftCorner(head_, head_) = head_covariance;
}

void MapCovariance::predict(const Eigen::Ref<const Eigen::MatrixXd>& transition,
                            const Eigen::Ref<const Eigen::MatrixXd>& noise) {
  auto head = data_.topLeftCorner(head_, head_);
  scratch_.noalias() = transition.lazyProduct(head);
  head.noalias() = scratch_.lazyProduct(transition.transpose());
  head += noise;
  if (landmarks_ == 0) return;
  scratch_.noalias() = transition.lazyProduct(transition_);
  transition_.swap(scratch_);
  waits_ = true;
}

void MapCovariance::catch_up() {
  // Rounding makes F P F^T a little lopsided; the update needs both halves equal.
  for (int j = 0; j < head_; ++j) {
    for (int i = 0; i < j; ++i) {
      const double mean = 0.5 * (data_(i, j) + data_(j, i));
      data_(i, j) = mean;
      data_(j, i) = mean;
    }
  }
  if (!waits_) return;
  // P_lh = P_lh F^T, column after column into the panel and back.
  const Eigen::Index rows = 2 * landmarks_;
  auto old = panel_.topLeftCorner(rows, head_);
  auto now = data_.block(head_, 0, rows, head_);
  old = now;
  for (int j = 0; j < head_; ++j) {
    double* out = now.col(j).data();
    now.col(j).setZero();
    for (int k = 0; k < head_; ++k) {
      if (transition_(j, k) != 0.0) add_one(out, rows, old.col(k).data(), transition_(j, k));
    }
  }
  transition_.setIdentity();
  waits_ = false;
}

Eigen::Matrix2d MapCovariance::between(int a, int b) const {
  if (a > b) return data_.block<2, 2>(row(a), row(b));
  if (a < b) return data_.block<2, 2>(row(b), row(a)).transpose();
  Eigen::Matrix2d own = data_.block<2, 2>(row(a), row(a));
  own(0, 1) = own(1, 0);
  return own;
}

void MapCovariance::append(const Eigen::Ref<const Eigen::MatrixXd>& by_head,
                           const Eigen::Matrix2d& noise) {
  assert(landmarks_ < capacity_);
  const Eigen::Index r = row(landmarks_);
  // Covariance of G head with everything: G P_h*.
  for (Eigen::Index k = 0; k < 2; ++k) {
    for (Eigen::Index j = 0; j < r; ++j) {
      double sum = 0.0;
      for (int h = 0; h < head_; ++h) {
        sum += by_head(k, h) * (j < head_ ? data_(h, j) : data_(j, h));
      }
      data_(r + k, j) = sum;
    }
  }
  Eigen::Matrix2d own = noise;
  for (Eigen::Index k = 0; k < 2; ++k) {
    for (Eigen::Index l = 0; l < 2; ++l) {
      for (int h = 0; h < head_; ++h) own(k, l) += data_(r + k, h) * by_head(l, h);
    }
  }
  data_(r, r) = own(0, 0);
  data_(r + 1, r) = 0.5 * (own(0, 1) + own(1, 0));
  data_(r + 1, r + 1) = own(1, 1);
  ++landmarks_;
}

void MapCovariance::add_landmark_columns(int landmark,
                                         const Eigen::Ref<const Eigen::Matrix2d>& factor,
                                         int first) {
  const Eigen::Index r = row(landmark);
  const Eigen::Index n = size();
  for (int c = 0; c < 2; ++c) {
    double* out = panel_.col(first + c).data();
    for (int k = 0; k < 2; ++k) {
      const double f = factor(k, c);
      const Eigen::Index at = r + k;
      for (Eigen::Index i = 0; i < at; ++i) out[i] = out[i] + data_(at, i) * f;
      add_one(out + at, n - at, &data_(at, at), f);
    }
  }
}

void MapCovariance::divide_panel(int rank, const Eigen::Ref<const Eigen::MatrixXd>& lower) {
  const Eigen::Index n = size();
  std::array<double, 4> w{};
  for (int k = 0; k < rank; ++k) {
    double* column = panel_.col(k).data();
    int j = 0;
    for (; j + 4 <= k; j += 4) {
      for (int l = 0; l < 4; ++l) w[static_cast<std::size_t>(l)] = -lower(k, j + l);
      add_four(column, n, panel_.col(j).data(), panel_.outerStride(), w.data());
    }
    for (; j < k; ++j) add_one(column, n, panel_.col(j).data(), -lower(k, j));
    panel_.col(k).head(n) *= 1.0 / lower(k, k);
  }
}

void MapCovariance::subtract(int rank, int heading, const Eigen::Ref<const Eigen::VectorXd>& lean) {
  assert(rank <= most_rank_);
  const Eigen::Index n = size();
  for (int k = 0; k < rank; ++k) weights_.row(k).head(n) = -panel_.col(k).head(n).transpose();
  // A P A^T = P + a q^T + q a^T with q = P e + (e^T P e / 2) a, P after the subtraction.
  auto q = panel_.col(rank + 1).head(n);
  q = data_.col(heading).head(n);
  for (int k = 0; k < rank; ++k) {
    add_one(q.data(), n, panel_.col(k).data(), -panel_(heading, k));
  }
  const double variance = q[heading];
  panel_.col(rank).head(n) = lean;
  add_one(q.data(), n, lean.data(), 0.5 * variance);
  weights_.row(rank).head(n) = q.transpose();
  weights_.row(rank + 1).head(n) = lean.transpose();
  add_weighted_panel(rank + 2);
}

void MapCovariance::add_weighted_panel(int columns) {
  // Two columns of P at a time, from the diagonal down. What the second one gets above the diagonal
  // is never read; after an odd number of columns comes one that nobody uses.
  const Eigen::Index n = size();
  const Eigen::Index stride = panel_.outerStride();
  for (Eigen::Index j = 0; j < n; j += 2) {
    const Eigen::Index from = j < head_ ? 0 : j;
    const Eigen::Index rows = n - from;
    double* p = &data_(from, j);
    double* q = &data_(from, j + 1);
    const double* w = weights_.col(j).data();
    const double* v = weights_.col(j + 1).data();
    int k = 0;
    for (; k + 4 <= columns; k += 4)
      add_four_to_two(p, q, rows, &panel_(from, k), stride, w + k, v + k);
    for (; k + 2 <= columns; k += 2)
      add_two_to_two(p, q, rows, &panel_(from, k), stride, w + k, v + k);
    for (; k < columns; ++k) {
      add_one(p, rows, &panel_(from, k), w[k]);
      add_one(q, rows, &panel_(from, k), v[k]);
    }
  }
}

}  // namespace nadir::fusion
