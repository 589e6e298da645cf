#include "control_client/experiment/experiment.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "control_client/simulation/plant.h"

namespace nadir::control_client {
namespace {

/// One run; each member does one part of a tick.
class Run {
 public:
  Run(const Scenario& scenario, std::span<Estimator* const> estimators)
      : scenario_(scenario),
        tick_s_(scenario.control.tick_s),
        estimators_(estimators),
        model_(scenario.robot),
        loop_(model_, scenario.control, scenario.nominal, scenario.trajectory),
        plant_(model_, scenario.trajectory->at(0.0).pose),
        encoders_(scenario.encoders, model_.wheel_count(), scenario.run_seed),
        vision_(scenario.vision, tick_s_, scenario.run_seed) {
    record_.tick_s = tick_s_;
    record_.start = plant_.pose();
    record_.estimates.resize(estimators.size());
    for (Estimator* estimator : estimators_) {
      estimator->start(tick_time(0, tick_s_), plant_.pose_world_robot());
    }
    if (scenario.race) race_.emplace(*scenario.race);
    lead();
  }

  RunRecord finish() {
    const double duration_s =
        scenario_.duration_s > 0.0 ? scenario_.duration_s : scenario_.trajectory->duration_s();
    const int last = static_cast<int>(std::floor(duration_s / tick_s_ + 1e-9));
    for (int tick = 1; tick <= last; ++tick) advance(tick);
    for (const Estimator* estimator : estimators_) {
      record_.decisions.push_back(estimator->decisions());
    }
    return std::move(record_);
  }

 private:
  void advance(int tick) {
    TickRecord now;
    now.time_s = tick * tick_s_;
    const NominalMotion nominal_before = nominal_;
    drive(now);
    if (const auto& kidnapping = scenario_.faults.kidnapping;
        kidnapping && tick == static_cast<int>(std::lround(kidnapping->at_s / tick_s_))) {
      plant_.displace(kidnapping->by);
    }
    estimate(tick, now.measured_mean_rates, nominal_before);
    lead();
    now.command = scenario_.trajectory->at(now.time_s).pose;
    if (race_) now.command << race_->corner_m(), 0.0;
    now.nominal = nominal_;
    now.truth = plant_.pose();
    const Eigen::Vector3d deviation = now.truth - now.nominal.pose;
    record_.has_diverged = record_.has_diverged ||
                           deviation.head<2>().norm() > scenario_.diverged_m ||
                           std::abs(deviation.z()) > scenario_.diverged_rad;
    record_.ticks.push_back(now);
  }

  // The outer loop, or the guidance of a race.
  void lead() {
    const fusion::PlanarPose pose = estimators_.front()->pose();
    if (!race_) {
      loop_.tick(pose);
      nominal_ = loop_.nominal();
      return;
    }
    const Eigen::Vector3d& rates = loop_.tick_at(race_->body_rates(pose));
    nominal_ = {{pose.x_m, pose.y_m, pose.heading_rad},
                rotation_world_body(pose.heading_rad) * rates};
  }

  // Inner loop, plant and encoders over one tick.
  void drive(TickRecord& now) {
    const double step_s = scenario_.control.inner_step_s();
    const int steps = scenario_.control.inner_steps;
    Eigen::Vector3d measured_sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d true_sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < steps; ++i) {
      WheelVector voltages_v = loop_.inner_step(measured_rates_);
      now.demanded_voltage_v = std::max(now.demanded_voltage_v, loop_.demanded_voltage_v());
      if (const auto& failure = scenario_.faults.wheel_failure;
          failure && now.time_s > failure->at_s) {
        voltages_v(failure->wheel) = 0.0;
      }
      const auto& cable = scenario_.faults.cable;
      plant_.advance(voltages_v, step_s,
                     cable ? cable->at(plant_.pose().head<2>()) : Disturbance{});
      measured_rates_ =
          body_rates(encoders_.measured_rim_speeds_mps(plant_.mean_rim_speeds_mps(), step_s));
      measured_sum += measured_rates_;
      true_sum += body_rates(plant_.mean_rim_speeds_mps());
    }
    now.is_saturated = loop_.is_saturated();
    now.measured_mean_rates = fusion::BodyRates::from(measured_sum / steps);
    now.true_mean_rates = true_sum / steps;
  }

  // Odometry, capture and arriving frames.
  void estimate(int tick, const fusion::BodyRates& rates, const NominalMotion& nominal_before) {
    const OdometrySample odometry{tick_time(tick - 1, tick_s_), tick_time(tick, tick_s_), rates,
                                  nominal_before};
    if (vision_.captures_at(tick)) {
      record_.frames.push_back(vision_.capture(tick, plant_.pose_world_robot()));
    }
    const std::vector<VisionFrame> frames = vision_.arrivals(tick);
    std::vector<fusion::Timestamp> captures;
    captures.reserve(frames.size());
    for (const VisionFrame& frame : frames) {
      captures.push_back(tick_time(frame.capture_tick, tick_s_));
    }
    for (std::size_t i = 0; i < estimators_.size(); ++i) {
      estimators_[i]->add_odometry(odometry);
      estimators_[i]->add_frames(frames, captures);
      estimators_[i]->see_truth(plant_.pose_world_robot());
      record_.estimates[i].push_back({estimators_[i]->pose(), estimators_[i]->covariance()});
    }
  }

  Eigen::Vector3d body_rates(const WheelVector& rim_speeds_mps) const {
    return model_.geometry().body_rates(rim_speeds_mps).vector();
  }

  const Scenario& scenario_;
  double tick_s_;
  std::span<Estimator* const> estimators_;
  RobotModel model_;
  ControlLoop loop_;
  std::optional<RaceGuidance> race_;
  NominalMotion nominal_;
  Plant plant_;
  Encoders encoders_;
  VisionFeed vision_;
  Eigen::Vector3d measured_rates_ = Eigen::Vector3d::Zero();
  RunRecord record_;
};

}  // namespace

fusion::Timestamp tick_time(int tick, double tick_s) {
  // Zero would be a stamp that nobody set.
  constexpr fusion::Timestamp kStart = std::chrono::seconds(1000);
  return kStart + tick * fusion::from_seconds(tick_s);
}

RunRecord run_scenario(const Scenario& scenario, std::span<Estimator* const> estimators) {
  assert(scenario.trajectory && !estimators.empty());
  return Run(scenario, estimators).finish();
}

RunRecord run_scenario(const Scenario& scenario, Estimator& driver) {
  Estimator* const only[] = {&driver};
  return run_scenario(scenario, only);
}

}  // namespace nadir::control_client
