#include "calibration/colours/colours_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nadir::calibration {
namespace {

using vision::Bgr;
using vision::Colour;
using vision::ColourClasses;
using vision::kColourCount;

constexpr float kHighest = 255.0F;
/// With fewer samples the scatter is not known: taken as this, which is that of good light.
constexpr int kLeastForScatter = 3;
constexpr double kTypicalHueSigma_rad = 0.05;

double angle_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi));
}

/// Mean hue and scatter about it, every sample with equal weight.
void set_hue(const std::vector<const ColourSample*>& samples, ColourStatistics& statistics) {
  const Hue mean = hue_of(statistics.difference);
  statistics.hue_rad = mean.angle_rad;
  statistics.chroma = mean.chroma;
  statistics.hue_sigma_rad = kTypicalHueSigma_rad;
  if (samples.size() < static_cast<std::size_t>(kLeastForScatter)) return;
  double squares = 0.0;
  for (const ColourSample* sample : samples) {
    const double angle =
        angle_between(hue_of(sample->value - sample->surroundings).angle_rad, mean.angle_rad);
    squares += angle * angle;
  }
  statistics.hue_sigma_rad = std::sqrt(squares / static_cast<double>(samples.size() - 1));
}

ColourStatistics statistics_of(const std::vector<const ColourSample*>& samples) {
  ColourStatistics statistics;
  statistics.samples = static_cast<int>(samples.size());
  if (samples.empty()) return statistics;
  for (const ColourSample* sample : samples) {
    statistics.value += sample->value;
    statistics.difference += sample->value - sample->surroundings;
  }
  statistics.value /= static_cast<float>(samples.size());
  statistics.difference /= static_cast<float>(samples.size());
  set_hue(samples, statistics);
  return statistics;
}

std::vector<ColourMargin> margins(const ColourStudy& study) {
  std::vector<ColourMargin> all;
  for (int i = 0; i < kColourCount; ++i) {
    for (int j = i + 1; j < kColourCount; ++j) {
      const auto a = static_cast<Colour>(i);
      const auto b = static_cast<Colour>(j);
      if (!has_hue(a) || !has_hue(b) || study.of(a).samples == 0 || study.of(b).samples == 0) {
        continue;
      }
      const double hue_rad = angle_between(study.of(a).hue_rad, study.of(b).hue_rad);
      const double sigma_rad =
          std::max({study.of(a).hue_sigma_rad, study.of(b).hue_sigma_rad, 1e-3});
      all.push_back({a, b, hue_rad, 0.5 * hue_rad / sigma_rad});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const ColourMargin& x, const ColourMargin& y) { return x.sigmas < y.sigmas; });
  return all;
}

/// Scaled into the range of pixel values, each a whole number.
Bgr whole_numbers(Bgr value) {
  value.array() += std::max(0.0F, -value.minCoeff());
  if (value.maxCoeff() > kHighest) value *= kHighest / value.maxCoeff();
  return value.array().round().matrix();
}

}  // namespace

Hue hue_of(const Bgr& difference) {
  const double red_green = static_cast<double>(difference[2] - difference[1]);
  const double yellow_blue =
      static_cast<double>(0.5F * (difference[2] + difference[1]) - difference[0]);
  return {std::atan2(yellow_blue, red_green), std::hypot(red_green, yellow_blue)};
}

bool has_hue(Colour colour) { return colour != Colour::kWhite && colour != Colour::kBlack; }

ColourStudy study_colours(const std::vector<ColourSample>& samples) {
  ColourStudy study;
  for (int i = 0; i < kColourCount; ++i) {
    std::vector<const ColourSample*> own;
    for (const ColourSample& sample : samples) {
      if (static_cast<int>(sample.colour) == i) own.push_back(&sample);
    }
    study.colours[static_cast<std::size_t>(i)] = statistics_of(own);
  }
  study.margins = margins(study);
  return study;
}

ColourClasses lit_default_classes(const Bgr& gains) {
  ColourClasses classes = vision::default_colour_classes();
  for (Bgr& typical : classes.typical) typical = whole_numbers(typical.cwiseProduct(gains));
  return classes;
}

Bgr light_gains(const ColourStudy& study) {
  // Least squares of log ratios; channels of the default that are nearly dark tell nothing.
  constexpr float kTells = 60.0F;
  const ColourClasses defaults = vision::default_colour_classes();
  Bgr sum = Bgr::Zero();
  Bgr weight = Bgr::Zero();
  for (int i = 0; i < kColourCount; ++i) {
    const auto colour = static_cast<Colour>(i);
    const ColourStatistics& seen = study.of(colour);
    if (seen.samples == 0 || !has_hue(colour)) continue;
    for (int channel = 0; channel < 3; ++channel) {
      if (defaults.of(colour)[channel] < kTells || seen.value[channel] < 1.0F) continue;
      sum[channel] += std::log(seen.value[channel] / defaults.of(colour)[channel]);
      weight[channel] += 1.0F;
    }
  }
  if (weight.minCoeff() < 1.0F) return Bgr::Ones();
  const Bgr mean = sum.cwiseQuotient(weight);
  return (mean.array() - mean.mean()).exp().matrix();
}

ColourClasses classes_from(const ColourStudy& study) {
  ColourClasses classes = lit_default_classes(light_gains(study));
  for (int i = 0; i < kColourCount; ++i) {
    const ColourStatistics& seen = study.of(static_cast<Colour>(i));
    if (seen.samples > 0 && has_hue(static_cast<Colour>(i))) {
      classes.typical[static_cast<std::size_t>(i)] = whole_numbers(seen.difference);
    }
  }
  return classes;
}

}  // namespace nadir::calibration
