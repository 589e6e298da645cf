#include "control_client/differential/differential_run.h"

#include <cmath>
#include <deque>

#include "fusion/magnetic_heading.h"

namespace nadir::control_client {
namespace {

bool is_within(double time_s, double begin_s, double duration_s) {
  return time_s >= begin_s && time_s < begin_s + duration_s;
}

// What happens in one period.
struct Period {
  UnicycleMotion wheels;         // as the wheels turn
  double turn_rate_radps = 0.0;  // of the robot
  fusion::PlanarPose truth;      // at its end
  double end_s = 0.0;
};

// A heading that a camera saw, on its way.
struct LateHeading {
  double captured_s = 0.0;
  double heading_rad = 0.0;
};

// The robot's own idea of where it is.
class DeadReckoning {
 public:
  DeadReckoning(const DifferentialScenario& scenario, const fusion::PlanarPose& start,
                std::uint64_t seed)
      : scenario_(scenario),
        gyro_(scenario.errors, seed),
        magnetometer_(scenario.errors, seed),
        camera_(seed, RandomPurpose::kHeading),
        filter_(scenario.filter),
        pose_(start) {
    filter_.start(start.heading_rad, scenario.magnetometer_variance_rad2, 0.01);
  }

  const fusion::PlanarPose& pose() const { return pose_; }

  void advance(const Period& period) {
    const double dt_s = scenario_.period_s;
    const double heading_rad = heading_after(period);
    const double turn_rad = fusion::wrap_angle(heading_rad - pose_.heading_rad);
    pose_ = moved(pose_, {period.wheels.speed_mps, turn_rad / dt_s}, dt_s);
    pose_.heading_rad = heading_rad;
  }

 private:
  double heading_after(const Period& period) {
    switch (scenario_.heading_from) {
      case HeadingFrom::kTruth:
        return period.truth.heading_rad;
      case HeadingFrom::kWheels:
        return fusion::wrap_angle(pose_.heading_rad +
                                  scenario_.period_s * period.wheels.turn_rate_radps);
      case HeadingFrom::kFilter:
        filter(period);
        break;
    }
    return filter_.heading_rad();
  }

  void filter(const Period& period) {
    const double felt =
        scenario_.kick.gyro_feels_it ? period.turn_rate_radps : period.wheels.turn_rate_radps;
    filter_.predict(gyro_.sample(felt, scenario_.period_s), scenario_.period_s);
    MagneticField field;
    if (is_within(period.end_s, scenario_.iron.begin_s, scenario_.iron.duration_s)) {
      field.disturbance_world = scenario_.iron.disturbance_world;
    }
    const Eigen::Vector3d measured = magnetometer_.sample(period.truth.heading_rad, field);
    const fusion::FieldGate gate{
        scenario_.field_tolerance > 0.0 ? std::hypot(1.0, field.down) : 0.0,
        scenario_.field_tolerance};
    if (gate.passes(measured)) {
      filter_.correct(fusion::HeadingSource::kMagnetometer,
                      fusion::magnetic_heading_rad(measured, {}),
                      scenario_.magnetometer_variance_rad2);
    }
    look(period);
  }

  // Frames arrive late, and are compared with the heading then.
  void look(const Period& period) {
    const VisionHeadings& vision = scenario_.vision;
    if (!(vision.period_s > 0.0)) return;
    if (period.end_s >= next_frame_s_) {
      next_frame_s_ += vision.period_s;
      frames_.push_back(
          {period.end_s,
           fusion::wrap_angle(period.truth.heading_rad + vision.deviation_rad * camera_.normal())});
    }
    constexpr double kTolerance_s = 1e-9;
    while (!frames_.empty() &&
           period.end_s - frames_.front().captured_s >= vision.delay_s - kTolerance_s) {
      filter_.correct(fusion::HeadingSource::kVision, frames_.front().heading_rad,
                      vision.deviation_rad * vision.deviation_rad,
                      period.end_s - frames_.front().captured_s);
      frames_.pop_front();
    }
  }

  const DifferentialScenario& scenario_;
  SimulatedGyro gyro_;
  SimulatedMagnetometer magnetometer_;
  RandomStream camera_;
  fusion::HeadingFilter filter_;
  fusion::PlanarPose pose_;
  std::deque<LateHeading> frames_;
  double next_frame_s_ = 0.0;
};

}  // namespace

std::vector<DifferentialTick> run_differential(const DifferentialScenario& scenario,
                                               std::uint64_t seed) {
  const double dt_s = scenario.period_s;
  const Kick& kick = scenario.kick;
  UnicycleReference reference =
      reference_along(scenario.path->at(0.0), false, scenario.path->at(0.0).pose.z());
  Period period;
  period.truth = reference.pose;
  DeadReckoning robot(scenario, reference.pose, seed);
  TrackingController controller(scenario.controller, scenario.limits);
  std::vector<DifferentialTick> ticks;
  const int count = static_cast<int>(std::floor(scenario.path->duration_s() / dt_s + 1e-9));
  for (int k = 0; k <= count; ++k) {
    const double time_s = k * dt_s;
    reference = reference_along(scenario.path->at(time_s), false, reference.pose.heading_rad);
    const UnicycleMotion command = controller.command(reference, robot.pose(), dt_s);
    ticks.push_back({time_s, reference, period.truth, robot.pose(), command});

    period.wheels = motion_of(wheel_speeds(command, scenario.track_m), scenario.track_m);
    const bool is_kicked = is_within(time_s + 0.5 * dt_s, kick.begin_s, kick.duration_s);
    period.turn_rate_radps =
        period.wheels.turn_rate_radps + (is_kicked ? kick.turn_rad / kick.duration_s : 0.0);
    period.truth = moved(period.truth, {period.wheels.speed_mps, period.turn_rate_radps}, dt_s);
    period.end_s = time_s + dt_s;
    robot.advance(period);
  }
  return ticks;
}

}  // namespace nadir::control_client
