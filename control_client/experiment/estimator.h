#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "control_client/nominal_motion.h"
#include "control_client/simulation/vision_feed.h"
#include "fusion/body_rates.h"
#include "fusion/planar_pose.h"
#include "fusion/timestamp.h"

namespace nadir::control_client {

/// What the wheels said about one tick.
struct OdometrySample {
  fusion::Timestamp from{0};
  fusion::Timestamp to{0};
  fusion::BodyRates mean_rates;
  NominalMotion nominal;  ///< at `from`
};

/// What an estimator thinks of a frame that it was given.
struct FrameDecision {
  std::uint64_t number = 0;
  bool is_used = false;
  bool is_recovered = false;  ///< used although the gate rejected it
  double nis = 0.0;           ///< normalised innovation squared
};

/// Where the robot believes to be. Every tick of an experiment calls, in this order, add_odometry,
/// add_frames (with the frames that have just arrived, often none), see_truth, pose.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// The robot stands at a known place.
  virtual void start(fusion::Timestamp time, const fusion::PlanarPose& pose) = 0;
  virtual void add_odometry(const OdometrySample& odometry) = 0;
  /// `captures` has the capture time of each frame.
  virtual void add_frames(std::span<const VisionFrame> frames,
                          std::span<const fusion::Timestamp> captures) = 0;
  /// Only for yardsticks.
  virtual void see_truth(const fusion::PlanarPose& /*truth*/) {}

  virtual fusion::PlanarPose pose() const = 0;
  /// Nothing for estimators that do not know how good they are.
  virtual std::optional<fusion::PoseCovariance> covariance() const { return std::nullopt; }
  /// What is thought at the end of the run of the frames that came, in order of their numbers.
  virtual std::vector<FrameDecision> decisions() const { return {}; }

 protected:
  Estimator() = default;
  Estimator(const Estimator&) = default;
  Estimator& operator=(const Estimator&) = default;
};

/// Knows the truth.
class TruthEstimator : public Estimator {
 public:
  void start(fusion::Timestamp /*time*/, const fusion::PlanarPose& pose) override { pose_ = pose; }
  void add_odometry(const OdometrySample& /*odometry*/) override {}
  void add_frames(std::span<const VisionFrame> /*frames*/,
                  std::span<const fusion::Timestamp> /*captures*/) override {}
  void see_truth(const fusion::PlanarPose& truth) override { pose_ = truth; }
  fusion::PlanarPose pose() const override { return pose_; }

 private:
  fusion::PlanarPose pose_;
};

/// Adds up what the encoders say and never looks up.
class DeadReckoning : public Estimator {
 public:
  void start(fusion::Timestamp /*time*/, const fusion::PlanarPose& pose) override { pose_ = pose; }
  void add_odometry(const OdometrySample& odometry) override;
  void add_frames(std::span<const VisionFrame> /*frames*/,
                  std::span<const fusion::Timestamp> /*captures*/) override {}
  fusion::PlanarPose pose() const override { return pose_; }

 private:
  fusion::PlanarPose pose_;
};

/// Believes the frame captured last, as it is and as late as it came, until the next comes.
class HeldVision : public Estimator {
 public:
  void start(fusion::Timestamp time, const fusion::PlanarPose& pose) override;
  void add_odometry(const OdometrySample& /*odometry*/) override {}
  void add_frames(std::span<const VisionFrame> frames,
                  std::span<const fusion::Timestamp> captures) override;
  fusion::PlanarPose pose() const override { return pose_; }

 private:
  fusion::Timestamp capture_{0};
  fusion::PlanarPose pose_;
};

}  // namespace nadir::control_client
