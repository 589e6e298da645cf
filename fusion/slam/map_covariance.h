#pragma once

#include <Eigen/Core>

namespace nadir::fusion {

/// Covariance of a map: a head (the robot's pose and what is estimated with it) and landmarks of
/// two states each, order head, landmark 0, landmark 1 ... All room is reserved at once; nothing
/// allocates afterwards. Of the landmarks only the lower triangle is kept.
///
/// What odometry does to the covariances between head and landmarks waits until landmarks are seen
/// again, so a step of odometry costs the same for every size of the map.
class MapCovariance {
 public:
  /// `head` states, room for so many landmarks, and for changes of rank `most_rank`.
  MapCovariance(int head, int landmarks, int most_rank);

  int head() const { return head_; }
  int landmarks() const { return landmarks_; }
  int capacity() const { return capacity_; }
  int size() const { return head_ + 2 * landmarks_; }

  /// No landmarks, this covariance of the head.
  void restart(const Eigen::Ref<const Eigen::MatrixXd>& head_covariance);

  /// Head moves on: P_hh = F P_hh F^T + Q, P_lh = P_lh F^T (the latter later).
  void predict(const Eigen::Ref<const Eigen::MatrixXd>& transition,
               const Eigen::Ref<const Eigen::MatrixXd>& noise);

  /// Makes up for what waits; before the functions below.
  void catch_up();

  auto head_block() const { return data_.topLeftCorner(head_, head_); }
  /// Covariances of all states (rows) with those of the head.
  auto head_columns() const { return data_.topLeftCorner(size(), head_); }
  /// Between a landmark (rows) and the head.
  auto landmark_head(int landmark) const { return data_.block(row(landmark), 0, 2, head_); }
  /// Between two landmarks.
  Eigen::Matrix2d between(int a, int b) const;

  /// A new landmark x = G head + noise: `by_head` is G (2 x head), `noise` its own covariance.
  /// Needs landmarks() < capacity().
  void append(const Eigen::Ref<const Eigen::MatrixXd>& by_head, const Eigen::Matrix2d& noise);
  /// Forgets the last landmarks.
  void shrink(int landmarks) { landmarks_ = landmarks; }

  /// Columns of a change P H^T that is being put together: size() x rank.
  auto panel(int rank) { return panel_.topLeftCorner(size(), rank); }
  /// Adds (covariances of all states with a landmark) * factor, size() x columns, to the panel's
  /// columns from `first` on; factor is 2 x columns.
  void add_landmark_columns(int landmark, const Eigen::Ref<const Eigen::Matrix2d>& factor,
                            int first);

  /// Panel = panel * lower^-T, for its first `rank` columns; of `lower` the lower triangle is read.
  void divide_panel(int rank, const Eigen::Ref<const Eigen::MatrixXd>& lower);

  /// P -= Y Y^T for the first `rank` columns Y of the panel, and then P = A P A^T with
  /// A = I + a e^T, where e picks the head's state `heading`; a (`lean`) is zero there.
  void subtract(int rank, int heading, const Eigen::Ref<const Eigen::VectorXd>& lean);

 private:
  /// P += the panel's first columns times their weights.
  void add_weighted_panel(int columns);
  Eigen::Index row(int landmark) const { return head_ + 2 * landmark; }

  int head_;
  int capacity_;
  int most_rank_;
  int landmarks_ = 0;
  bool waits_ = false;
  Eigen::MatrixXd data_;        // the head's block is full, the landmarks' lower triangle
  Eigen::MatrixXd transition_;  // of the head, what waits
  Eigen::MatrixXd scratch_;     // head x head
  Eigen::MatrixXd panel_;       // two columns more than the largest rank
  Eigen::MatrixXd weights_;     // of the panel's columns, rows as the panel
};

}  // namespace nadir::fusion
