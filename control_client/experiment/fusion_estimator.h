#pragma once

#include <map>
#include <optional>
#include <type_traits>

#include "control_client/experiment/estimator.h"
#include "fusion/delayed_fusion.h"
#include "fusion/wheel_geometry.h"

namespace nadir::control_client {

/// Covariance of a start at a known place (theory 3): 1 mm, 1 mm, 0.6 deg.
inline fusion::PoseCovariance known_start_covariance() {
  return Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
}

/// Whether late frames are inserted where they were captured, or taken as if they were of now.
enum class LateFrames { kReplayed, kTakenAsNew };

/// Any DelayedFusion as the estimator of an experiment.
template <class Fusion>
class FusionEstimator : public Estimator {
 public:
  explicit FusionEstimator(const typename Fusion::Settings& settings,
                           LateFrames late = LateFrames::kReplayed)
      : fusion_(settings), late_(late) {}

  /// Takes these variances (m^2, m^2, rad^2) for every frame's own.
  void assume_variances(const Eigen::Vector3d& variances) { variances_ = variances; }

  void start(fusion::Timestamp time, const fusion::PlanarPose& pose) override {
    fusion_.start(time, pose, known_start_covariance());
    decisions_.clear();
  }

  void add_odometry(const OdometrySample& odometry) override {
    typename Fusion::Odometry input{odometry.from, odometry.to, odometry.mean_rates, {}};
    if constexpr (std::is_same_v<typename Fusion::Nominal, fusion::AlongNominal::Nominal>) {
      input.nominal = {odometry.nominal.pose.z(),
                       fusion::BodyRates::from(odometry.nominal.body_rates())};
    }
    fusion_.add_odometry(input);
  }

  void add_frames(std::span<const VisionFrame> frames,
                  std::span<const fusion::Timestamp> captures) override {
    if (frames.empty()) return;
    std::vector<fusion::VisionPose> poses(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      poses[i].frame = frames[i].number;
      poses[i].capture = late_ == LateFrames::kReplayed ? captures[i] : fusion_.now();
      poses[i].pose = frames[i].pose_world_robot;
      poses[i].covariance = variances_.value_or(frames[i].variances).asDiagonal();
    }
    std::vector<fusion::Correction> results(frames.size());
    fusion_.add_poses(poses, results);
    for (const fusion::FrameRecord& record : fusion_.frames()) {
      const std::uint64_t number = record.vision_pose().frame;
      decisions_[number] = {number, fusion::is_used(record.verdict),
                            record.verdict == fusion::PoseVerdict::kRecovered ||
                                record.verdict == fusion::PoseVerdict::kReset,
                            static_cast<double>(record.nis)};
    }
  }

  fusion::PlanarPose pose() const override { return fusion_.filter().state().pose; }
  std::optional<fusion::PoseCovariance> covariance() const override {
    return fusion_.filter().state().pose_covariance();
  }
  std::vector<FrameDecision> decisions() const override {
    std::vector<FrameDecision> all;
    for (const auto& [number, decision] : decisions_) all.push_back(decision);
    return all;
  }

  const Fusion& fusion() const { return fusion_; }

 private:
  Fusion fusion_;
  LateFrames late_;
  std::optional<Eigen::Vector3d> variances_;
  std::map<std::uint64_t, FrameDecision> decisions_;
};

/// The papers' filter and the extended Kalman filter, with white odometry noise.
using NominalFusion = fusion::DelayedFusion<fusion::AlongNominal>;
using EkfFusion = fusion::DelayedFusion<fusion::AboutEstimate>;

/// The papers' settings: rectangular gate, recovery, rims with white noise of `rim_sigma_mps`.
template <class Fusion>
typename Fusion::Settings paper_settings(const fusion::WheelGeometry& geometry,
                                         double rim_sigma_mps, double tick_s) {
  typename Fusion::Settings settings;
  settings.filter.gate = fusion::Gate::rectangular();
  settings.filter.odometry_error =
      fusion::WhiteOdometryNoise(geometry.rate_covariance(rim_sigma_mps), tick_s);
  return settings;
}

}  // namespace nadir::control_client
