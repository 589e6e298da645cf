#include "control_client/experiment/estimator.h"

#include "fusion/odometry.h"

namespace nadir::control_client {

void DeadReckoning::add_odometry(const OdometrySample& odometry) {
  pose_ =
      fusion::moved(pose_, odometry.mean_rates, fusion::to_seconds(odometry.to - odometry.from));
}

void HeldVision::start(fusion::Timestamp time, const fusion::PlanarPose& pose) {
  capture_ = time;
  pose_ = pose;
}

void HeldVision::add_frames(std::span<const VisionFrame> frames,
                            std::span<const fusion::Timestamp> captures) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (captures[i] <= capture_) continue;
    capture_ = captures[i];
    pose_ = frames[i].pose_world_robot;
  }
}

}  // namespace nadir::control_client
