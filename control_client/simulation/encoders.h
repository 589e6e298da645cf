#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "control_client/robot_model.h"
#include "control_client/simulation/random_stream.h"

namespace nadir::control_client {

enum class EncoderKind {
  kSlip,     ///< scale error, slip under acceleration, a little white noise
  kWhite,    ///< white noise alone, as the filter models it
  kPerfect,  ///< the true rim speeds
};

/// Errors of the simulated wheels against the floor. Per wheel and interval of length Ti, with the
/// true mean rim speed v and a = (v - v of the interval before) / Ti:
///
///     slip:   measured = v (1 + eps) + lam a + white_mps N(0, 1) sqrt(tick / Ti)
///             eps ~ N(0, scale^2) once a run,
///             lam = lam_mean + ph (lam - lam_mean) + sqrt(1 - ph^2) lam_deviation N(0, 1),
///             ph = exp(-Ti / slip_memory)
///     white:  measured = v + matched_mps N(0, 1) sqrt(tick / Ti)
///
/// The white noise of both kinds has a stream of its own. The stream of the slip draws eps and the
/// first lam of each wheel in turn, then lam of each wheel in each interval.
struct EncoderParameters {
  EncoderKind kind = EncoderKind::kSlip;
  double scale_deviation = 0.01;
  double slip_mean_s = 0.01;
  double slip_deviation_s = 0.02;
  double slip_memory_s = 0.5;
  double white_mps = 0.005;   ///< for an interval of one tick
  double matched_mps = 0.02;  ///< for an interval of one tick
  double tick_s = 0.02;
};

/// What the wheels' encoders report of the motion.
class Encoders {
 public:
  Encoders(const EncoderParameters& parameters, int wheels, std::uint64_t run_seed);

  /// The report of one interval of dt_s, m/s a wheel.
  WheelVector measured_rim_speeds_mps(const WheelVector& true_rim_speeds_mps, double dt_s);

 private:
  double slipping(double speed_mps, double acceleration_mps2, int wheel, double dt_s);

  EncoderParameters parameters_;
  RandomStream slip_stream_;
  RandomStream white_stream_;
  WheelVector scale_error_;
  WheelVector slip_s_;
  WheelVector last_speeds_mps_;
};

}  // namespace nadir::control_client
