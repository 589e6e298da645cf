#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Who measured a heading.
enum class HeadingSource : std::uint8_t { kMagnetometer, kVision };
inline constexpr std::size_t kHeadingSources = 2;

enum class HeadingVerdict : std::uint8_t {
  kAccepted,
  kRecovered,  ///< beyond the gate, but said so often that it is believed
  kGated,
  kRefused,  ///< no number, no variance, or older than what is remembered
};

/// The defaults are S1's: q = 0.01 for both noises, at 50 Hz.
struct HeadingFilterSettings {
  double gyro_variance_rad2ps2 = 0.01;  ///< of one sample of sample_s
  double sample_s = 0.02;
  double bias_walk_rad2ps3 = 0.01;  ///< intensity: the bias' variance grows by so much in a second
  double gate_nis = 12.25;          ///< believed up to here: 3.5 sigma; 0: everything is
  /// So many measurements beyond the gate in a row that say the same are believed; 0: never. A
  /// quarter of a second of a magnetometer at 50 Hz.
  int recover_after = 12;
  /// Not while another source was accepted within this time: it knows better.
  double trusted_s = 1.0;
};

/// Heading and gyro bias from a gyro and from headings measured by anything else (S1 eq 26 to 31,
/// with the bias subtracted and the measurement of the new heading):
///
///     theta+ = theta + Ts (gyro - b) + noise,   b+ = b + noise,   z = theta + noise
///     Q = diag(gyro_variance Ts^2, bias_walk Ts)
///
/// Late measurements of age a are compared with the heading then, theta - turn of the gyro + a b,
/// so they tell of the bias, too; the gyro's noise meanwhile is added to their variance. Nothing is
/// allocated, nothing throws.
class HeadingFilter {
 public:
  explicit HeadingFilter(const HeadingFilterSettings& settings) : settings_(settings) {}

  /// Forgets all and starts with a heading and no bias; variances in rad^2 and (rad/s)^2, above 0.
  void start(double heading_rad, double heading_variance_rad2, double bias_variance_rad2ps2);

  /// dt_s > 0 later; the gyro's mean rate over this time, counter-clockwise.
  void predict(double gyro_radps, double dt_s);

  /// A heading that was measured age_s >= 0 before the last prediction's end.
  HeadingVerdict correct(HeadingSource source, double heading_rad, double variance_rad2,
                         double age_s = 0.0);

  double heading_rad() const { return wrap_angle(state_(0)); }
  double bias_radps() const { return state_(1); }
  const Eigen::Matrix2d& covariance() const { return covariance_; }
  /// Of the last correction, for heading and bias.
  const Eigen::Vector2d& gain() const { return gain_; }
  double time_s() const { return time_s_; }

 private:
  struct Turn {
    double time_s = 0.0;
    double gyro_rad = 0.0;  // raw, since the start
  };
  struct SourceRecord {
    int gated_in_a_row = 0;
    double last_gated_rad = 0.0;  // innovation
    std::optional<double> last_accepted_s;
  };
  static constexpr std::size_t kTurns = 128;  // remembered

  std::optional<double> gyro_turn_since(double time_s) const;
  bool is_recovered(HeadingSource source, double innovation_rad, double variance_rad2);
  void update(const Eigen::RowVector2d& observation, double innovation_rad, double variance_rad2);

  HeadingFilterSettings settings_;
  Eigen::Vector2d state_ = Eigen::Vector2d::Zero();  // heading (unwrapped), bias
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Identity();
  Eigen::Vector2d gain_ = Eigen::Vector2d::Zero();
  double time_s_ = 0.0;
  double gyro_rad_ = 0.0;
  std::array<Turn, kTurns> turns_ = {};
  std::size_t newest_ = 0;
  std::size_t remembered_ = 1;
  std::array<SourceRecord, kHeadingSources> sources_ = {};
};

}  // namespace nadir::fusion
