#include "fusion/slam/map_covariance.h"

#include <algorithm>
#include <cassert>

namespace nadir::fusion {
namespace {

// Four columns at a time: out += a0 b0 + a1 b1 + a2 b2 + a3 b3, element by element in this order,
// so that vector instructions of any width give the same bits.
void add_four(double* out, Eigen::Index n, const double* a0, const double* a1, const double* a2,
              const double* a3, const double* b) {
  for (Eigen::Index i = 0; i < n; ++i) {
    out[i] = out[i] + (((a0[i] * b[0] + a1[i] * b[1]) + a2[i] * b[2]) + a3[i] * b[3]);
  }
}

void add_one(double* out, Eigen::Index n, const double* a, double b) {
  for (Eigen::Index i = 0; i < n; ++i) out[i] = out[i] + a[i] * b;
}

}  // namespace

MapCovariance::MapCovariance(int head, int landmarks, int most_rank)
    : head_(head), capacity_(landmarks), most_rank_(most_rank) {
  const Eigen::Index n = head + 2 * landmarks;
  data_ = Eigen::MatrixXd::Zero(n, n);
  transition_ = Eigen::MatrixXd::Identity(head, head);
  scratch_ = Eigen::MatrixXd::Zero(head, head);
  panel_ =
      Eigen::MatrixXd::Zero(n, std::max(head, most_rank + 2));  // also holds the head's columns
  weights_ = Eigen::MatrixXd::Zero(most_rank + 2, n);
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
  const int columns = rank + 2;
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::Index from = j < head_ ? 0 : j;
    double* out = &data_(from, j);
    const double* weight = weights_.col(j).data();
    int k = 0;
    for (; k + 4 <= columns; k += 4) {
      add_four(out, n - from, &panel_(from, k), &panel_(from, k + 1), &panel_(from, k + 2),
               &panel_(from, k + 3), weight + k);
    }
    for (; k < columns; ++k) add_one(out, n - from, &panel_(from, k), weight[k]);
  }
}

}  // namespace nadir::fusion
