// The rover driven by the onboard process in simulated time: the loop of every other robot.

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <vector>

#include "control_client/drive/drive_core.h"
#include "control_client/rover/rover_base.h"
#include "control_client/simulation/random_stream.h"
#include "control_client/trajectory.h"

namespace nadir::control_client {
namespace {

using fusion::Timestamp;
using namespace std::chrono_literals;

struct Quality {
  double estimate_rms_m = 0.0;
  double tracking_rms_m = 0.0;
  tracker::ClientMode mode = tracker::ClientMode::kStarting;
};

/// Poses at 50 Hz, 80 ms late, of 0.2 mm and 2 mrad; a command each tick of 20 ms.
class Loop {
 public:
  explicit Loop(const char* trajectory)
      : trajectory_(standard_trajectory(trajectory)),
        core_(model_, settings(), trajectory_),
        base_(RoverRobot{}, simulation(trajectory_->at(0.0).pose), now_, {}) {}

  Quality drive(double duration_s) {
    Quality quality;
    double ticks = 0.0;
    for (double t = 0.0; t < duration_s; t += 0.02) {
      tick();
      if (!core_.estimate() || core_.plan().phase() != MotionPlan::Phase::kFollow) continue;
      const fusion::PlanarPose truth = *base_.truth_at(now_);
      const Eigen::Vector2d nominal = core_.plan().motion().pose.head<2>();
      quality.estimate_rms_m +=
          (core_.estimate()->pose.position_m() - truth.position_m()).squaredNorm();
      quality.tracking_rms_m += (truth.position_m() - nominal).squaredNorm();
      ticks += 1.0;
    }
    quality.estimate_rms_m = std::sqrt(quality.estimate_rms_m / ticks);
    quality.tracking_rms_m = std::sqrt(quality.tracking_rms_m / ticks);
    quality.mode = core_.verdict().mode;
    return quality;
  }

 private:
  static DriveSettings settings() {
    DriveSettings settings;
    settings.output = tracker::WheelCommandKind::kBodyRates;
    settings.control.inner_steps = 1;
    settings.plan.repeats = true;
    return settings;
  }
  static SimulationSettings simulation(const Eigen::Vector3d& start) {
    SimulationSettings settings;
    settings.start = start;
    return settings;
  }

  void tick() {
    now_ += 20ms;
    base_.take_odometry(now_, &odometry_);
    for (const OdometryInterval& each : odometry_) core_.add_odometry(each);
    see();
    base_.command(core_.step(now_, 1), now_);
  }

  void see() {
    constexpr std::uint64_t kEpoch = 7;
    core_.add_clock({.epoch = kEpoch,
                     .sequence = frame_,
                     .t1_ns = now_.count() - 200'000,
                     .t2_ns = now_.count() - 100'000,
                     .t3_ns = now_.count() - 100'000,
                     .t4_ns = now_.count()});
    const fusion::PlanarPose truth = *base_.truth_at(now_);
    tracker::WirePose pose;
    pose.camera = "cam0";
    pose.epoch = kEpoch;
    pose.frame = frame_++;
    pose.capture_ns = now_.count();
    pose.robot.team = "blue";
    pose.robot.pose_world_robot = {truth.x_m + 2e-4 * random_.normal(),
                                   truth.y_m + 2e-4 * random_.normal(),
                                   fusion::wrap_angle(truth.heading_rad + 2e-3 * random_.normal())};
    pose.robot.covariance = Eigen::Vector3d(4e-8, 4e-8, 4e-6).asDiagonal();
    on_the_way_.push_back(pose);
    if (on_the_way_.size() <= 4) return;
    core_.add_pose(on_the_way_.front());
    on_the_way_.pop_front();
  }

  TrajectoryPtr trajectory_;
  RobotModel model_{rover_description({})};
  Timestamp now_{1000s};
  DriveCore core_;
  RoverBase base_;
  RandomStream random_{3, RandomPurpose::kVision};
  std::uint64_t frame_ = 0;
  std::deque<tracker::WirePose> on_the_way_;
  std::vector<OdometryInterval> odometry_;
};

TEST(RoverDrive, FollowsTrajectoriesAsOtherRobotsDo) {
  for (const char* trajectory : {"square-turning", "circle", "rose3"}) {
    Loop loop(trajectory);
    loop.drive(3.0);
    const Quality quality = loop.drive(15.0);
    EXPECT_EQ(quality.mode, tracker::ClientMode::kDriving) << trajectory;
    EXPECT_LT(quality.estimate_rms_m, 0.003) << trajectory;
    EXPECT_LT(quality.tracking_rms_m, 0.010) << trajectory;
  }
}

}  // namespace
}  // namespace nadir::control_client
