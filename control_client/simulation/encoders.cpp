#include "control_client/simulation/encoders.h"

#include <cmath>

namespace nadir::control_client {

Encoders::Encoders(const EncoderParameters& parameters, int wheels, std::uint64_t run_seed)
    : parameters_(parameters),
      slip_stream_(run_seed, RandomPurpose::kSlip),
      white_stream_(run_seed, RandomPurpose::kWheelNoise),
      scale_error_(wheels),
      slip_s_(wheels),
      last_speeds_mps_(WheelVector::Zero(wheels)) {
  for (int i = 0; i < wheels; ++i) {
    scale_error_(i) = parameters.scale_deviation * slip_stream_.normal();
    slip_s_(i) = parameters.slip_mean_s + parameters.slip_deviation_s * slip_stream_.normal();
  }
}

double Encoders::slipping(double speed_mps, double acceleration_mps2, int wheel, double dt_s) {
  const double keep = std::exp(-dt_s / parameters_.slip_memory_s);
  double& slip_s = slip_s_(wheel);
  slip_s = parameters_.slip_mean_s + keep * (slip_s - parameters_.slip_mean_s) +
           std::sqrt(1.0 - keep * keep) * parameters_.slip_deviation_s * slip_stream_.normal();
  return speed_mps * (1.0 + scale_error_(wheel)) + slip_s * acceleration_mps2 +
         parameters_.white_mps * std::sqrt(parameters_.tick_s / dt_s) * white_stream_.normal();
}

WheelVector Encoders::measured_rim_speeds_mps(const WheelVector& true_rim_speeds_mps, double dt_s) {
  WheelVector measured = true_rim_speeds_mps;
  for (int i = 0; i < static_cast<int>(measured.size()); ++i) {
    const double speed_mps = true_rim_speeds_mps(i);
    if (parameters_.kind == EncoderKind::kSlip) {
      measured(i) = slipping(speed_mps, (speed_mps - last_speeds_mps_(i)) / dt_s, i, dt_s);
    } else if (parameters_.kind == EncoderKind::kWhite) {
      measured(i) +=
          parameters_.matched_mps * std::sqrt(parameters_.tick_s / dt_s) * white_stream_.normal();
    }
  }
  last_speeds_mps_ = true_rim_speeds_mps;
  return measured;
}

}  // namespace nadir::control_client
