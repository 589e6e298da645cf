#include "tracker/alignment/sensor_lesson.h"

#include <Eigen/LU>

namespace nadir::tracker {
namespace {

constexpr double kKnownBlur_px = 0.01;
constexpr double kLeastInside = 12.0;  // pixels, to see a slope of light
constexpr double kLeastLevel = 30.0;   // grey levels: darker, and noise is all there is
constexpr double kFitted = 0.5;        // of a level's degree of freedom falls to either side

double d(float value) { return static_cast<double>(value); }

void teach_noise(const ChannelLevels& levels, const ChannelScatter& scatter, SensorModel& sensor) {
  if (scatter.inside_count > 1.0F) {
    sensor.learn_noise(levels.level + levels.contrast,
                       d(scatter.inside_squares) / (d(scatter.inside_count) - kFitted),
                       d(scatter.inside_count));
  }
  if (scatter.outside_count > 1.0F) {
    sensor.learn_noise(levels.level,
                       d(scatter.outside_squares) / (d(scatter.outside_count) - kFitted),
                       d(scatter.outside_count));
  }
}

// The slope of the residuals well inside of a disc is that of the light.
void teach_light(const vision::PixelPoint& origin_px, const ChannelLevels& levels,
                 const ChannelScatter& scatter, SensorModel& sensor) {
  const double n = d(scatter.inside_count);
  const double level = levels.level + levels.contrast;
  if (n < kLeastInside || level < kLeastLevel) return;
  const Eigen::Vector2d mean = Eigen::Vector2d(d(scatter.u), d(scatter.v)) / n;
  const Eigen::Vector2d squares =
      Eigen::Vector2d(d(scatter.uu), d(scatter.vv)) - n * mean.cwiseAbs2();
  const Eigen::Vector2d moment =
      Eigen::Vector2d(d(scatter.iu), d(scatter.iv)) - mean * d(scatter.i);
  if (!(squares.minCoeff() > 1.0)) return;
  const vision::PixelPoint place = origin_px + mean;
  const Eigen::Vector2d slope = moment.cwiseQuotient(squares) / level;
  sensor.light.learn(place, slope + sensor.light.slope_per_px(place),
                     sensor.noise().variance(level) / (squares.mean() * level * level));
}

// Derivative of the log likelihood by the blur, and its information, levels eliminated.
struct BlurEvidence {
  double score = 0.0;
  double information = 0.0;
};

void add_blur(const ChannelLevels& levels, const ChannelScatter& scatter, BlurEvidence& evidence) {
  Eigen::Matrix2d aa;
  aa << d(scatter.n), d(scatter.s), d(scatter.s), d(scatter.ss);
  if (!(aa.determinant() > 1e-4 * aa(0, 0) * aa(0, 0))) return;
  const Eigen::Vector2d ab(d(scatter.b), d(scatter.sb));
  const Eigen::Vector2d ar(d(scatter.r), d(scatter.sr));
  const Eigen::Vector2d gain = aa.inverse() * ab;
  evidence.score += levels.contrast * (d(scatter.br) - gain.dot(ar));
  evidence.information += levels.contrast * levels.contrast * (d(scatter.bb) - gain.dot(ab));
}

}  // namespace

void teach(const cv::Mat& image, Mosaic mosaic, std::size_t disc, RobotFit& fit,
           SensorModel& sensor, const OutlierLimits& limits) {
  if (!fit.counts(disc) || !fit.gather_whole({image, mosaic, sensor.light}, disc)) return;
  DiscState& state = fit.disc(disc);
  state.look_at_blur(fit.view().edge(disc));
  // Uneven light tells nothing of optics, but a blur that is not known yet looks like it.
  const bool even = !fit.is_uneven(disc);
  BlurEvidence blur;
  for (int c = 0; c < 3; ++c) {
    const ChannelLevels& levels = state.levels[static_cast<std::size_t>(c)];
    const ChannelScatter scatter =
        scatter_of(state.patch, state.shares, state.model(c, sensor.noise(), limits));
    teach_noise(levels, scatter, sensor);
    if (even) teach_light(state.patch.origin_px, levels, scatter, sensor);
    add_blur(levels, scatter, blur);
  }
  if (!even && sensor.blur_deviation_px() < kKnownBlur_px) return;
  sensor.learn_blur(blur.score / fit.inflation(disc), blur.information / fit.inflation(disc));
}

}  // namespace nadir::tracker
