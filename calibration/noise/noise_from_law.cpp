#include "calibration/noise/noise_from_law.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

/// Counts within this factor are one class.
constexpr double kClassFactor = 1.4;
/// Counts must differ by this much before a floor can be told from the 1/N part.
constexpr double kFloorFactor = 2.0;
/// Law and class that differ by more than this are worth a word.
constexpr double kGoodRatio = 1.25;
constexpr double kLeastVariance_m2 = 1e-14;  // a nanometre's worth: below are rounding errors

/// One span as the law sees it.
struct Evidence {
  std::vector<double> pixels;
  double degrees_of_freedom = 0.0;
  double variance_m2 = 0.0;  ///< of the middle, the grid's part included
  double grid_m2 = 0.0;      ///< of one mark
};

double mean_pixels(const std::vector<double>& pixels) {
  double sum = 0.0;
  for (const double each : pixels) sum += each;
  return sum / static_cast<double>(pixels.size());
}

double square_m2(const StandingSpan& span) {
  return std::abs(span.jacobian_m_per_px.determinant());
}

double grid_m2(const StandingSpan& span, const NoiseLawSettings& settings) {
  const double detected_px2 = settings.grid_variance_px2 / std::sqrt(mean_pixels(span.pixels));
  return square_m2(span) * ((1.0 - span.aligned_share) * detected_px2 +
                            span.aligned_share * settings.aligned_grid_variance_px2);
}

std::vector<Evidence> evidence(const StandingData& data, const NoiseLawSettings& settings) {
  std::vector<Evidence> all;
  for (const StandingSpan& span : data.spans) {
    const double grid = grid_m2(span, settings);
    const double marks = static_cast<double>(span.pixels.size());
    all.push_back({span.pixels, 2.0 * (span.samples - 1),
                   std::max(span.middle_variance_m2 + grid / marks, kLeastVariance_m2), grid});
  }
  return all;
}

/// V of a law whose constants have the ratio floor / pixel_variance, over pixel_variance.
double unit_variance(const std::vector<double>& pixels, double floor_ratio) {
  double weight = 0.0;
  for (const double count : pixels) weight += 1.0 / (1.0 / count + floor_ratio);
  return 1.0 / weight;
}

struct LawFit {
  double pixel_variance_m2 = 0.0;
  double deviance = 0.0;  ///< twice the negative log likelihood, but for a constant
};

/// With the ratio given, the best constant is a weighted mean.
LawFit fit_with_ratio(const std::vector<Evidence>& all, double floor_ratio) {
  double freedom = 0.0;
  double sum_m2 = 0.0;
  for (const Evidence& each : all) {
    freedom += each.degrees_of_freedom;
    sum_m2 += each.degrees_of_freedom * each.variance_m2 / unit_variance(each.pixels, floor_ratio);
  }
  LawFit fit;
  fit.pixel_variance_m2 = sum_m2 / freedom;
  for (const Evidence& each : all) {
    const double predicted = fit.pixel_variance_m2 * unit_variance(each.pixels, floor_ratio);
    fit.deviance += each.degrees_of_freedom * (std::log(predicted) + each.variance_m2 / predicted);
  }
  return fit;
}

/// Smallest and largest mean count of a span.
std::pair<double, double> count_range(const std::vector<Evidence>& all) {
  double low = mean_pixels(all.front().pixels);
  double high = low;
  for (const Evidence& each : all) {
    low = std::min(low, mean_pixels(each.pixels));
    high = std::max(high, mean_pixels(each.pixels));
  }
  return {low, high};
}

LawVariance fit_law(const std::vector<Evidence>& all, bool with_floor) {
  double best_ratio = 0.0;
  LawFit best = fit_with_ratio(all, 0.0);
  if (with_floor) {
    // A grid of ratios, from a floor of no account to one that is nearly all.
    constexpr int kSteps = 400;
    const auto [low, high] = count_range(all);
    for (int i = 0; i <= kSteps; ++i) {
      const double ratio =
          1e-3 / high * std::pow(1e5 * high / low, static_cast<double>(i) / kSteps);
      const LawFit fit = fit_with_ratio(all, ratio);
      if (fit.deviance < best.deviance) {
        best = fit;
        best_ratio = ratio;
      }
    }
  }
  LawVariance law;
  law.pixel_variance_m2 = best.pixel_variance_m2;
  law.floor_m2 = best_ratio * best.pixel_variance_m2;
  return law;
}

double law_m2(const LawVariance& law, double pixels) {
  return law.pixel_variance_m2 / pixels + law.floor_m2;
}

/// The class of spans [first, last), which are sorted by their counts.
PixelClass class_of(const std::vector<const StandingSpan*>& spans, std::size_t first,
                    std::size_t last, const NoiseLawSettings& settings) {
  PixelClass sum;
  double freedom = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const StandingSpan& span = *spans[i];
    const double weight = span.samples - 1;
    freedom += weight;
    sum.samples += span.samples;
    sum.pixels += weight * mean_pixels(span.pixels);
    sum.pose_variance += weight * span.covariance.diagonal();
    const double grid = grid_m2(span, settings);
    sum.grid_variance_m2 += weight * grid;
    sum.mark_variance_m2 +=
        weight * (static_cast<double>(span.pixels.size()) * span.middle_variance_axes_m2 +
                  Eigen::Vector2d::Constant(grid));
  }
  sum.pixels /= freedom;
  sum.pose_variance /= freedom;
  sum.mark_variance_m2 /= freedom;
  sum.grid_variance_m2 /= freedom;
  return sum;
}

std::vector<PixelClass> classes(const StandingData& data, const NoiseLawSettings& settings) {
  std::vector<const StandingSpan*> spans;
  for (const StandingSpan& span : data.spans) spans.push_back(&span);
  std::sort(spans.begin(), spans.end(), [](const auto* a, const auto* b) {
    return mean_pixels(a->pixels) < mean_pixels(b->pixels);
  });
  std::vector<PixelClass> result;
  for (std::size_t first = 0; first < spans.size();) {
    const double start = mean_pixels(spans[first]->pixels);
    std::size_t last = first + 1;
    while (last < spans.size() && mean_pixels(spans[last]->pixels) < kClassFactor * start) ++last;
    result.push_back(class_of(spans, first, last, settings));
    if (result.size() > 1) {
      // Half way between the classes, in ratio.
      result.back().from_pixels =
          std::sqrt(result[result.size() - 2].pixels * result.back().pixels);
    }
    first = last;
  }
  return result;
}

/// Slope of log variance against log count, weighted with the samples.
double power(const std::vector<PixelClass>& all) {
  if (all.size() < 2) return -1.0;
  double weight = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  const auto logs = [](const PixelClass& each) {
    return Eigen::Vector2d(std::log(each.pixels), std::log(each.mark_variance_m2.mean()));
  };
  for (const PixelClass& each : all) {
    weight += each.samples;
    mean += each.samples * logs(each);
  }
  mean /= weight;
  double xx = 0.0;
  double xy = 0.0;
  for (const PixelClass& each : all) {
    const Eigen::Vector2d d = logs(each) - mean;
    xx += each.samples * d.x() * d.x();
    xy += each.samples * d.x() * d.y();
  }
  return xy / xx;
}

/// Heading variances are those of the spans where both marks are in one class, and the mean of two
/// classes' where they are not.
TableVariance table(const std::vector<PixelClass>& all, double minimum_pixels) {
  TableVariance result;
  for (const PixelClass& row : all) {
    TableVariance::Class each;
    each.from_pixels = std::max(row.from_pixels, minimum_pixels);
    each.x_m2 = row.mark_variance_m2.x();
    each.y_m2 = row.mark_variance_m2.y();
    for (const PixelClass& column : all) {
      each.heading_rad2.push_back(
          std::max(1e-12, 0.5 * (row.pose_variance.z() + column.pose_variance.z())));
    }
    result.classes.push_back(std::move(each));
  }
  return result;
}

/// The mean, over all samples, of what scattered beyond the published variance, of one mark and px.
std::optional<double> alignment_floor_px(const StandingData& data) {
  double samples = 0.0;
  double sum_px2 = 0.0;
  for (const StandingSpan& span : data.spans) {
    if (span.aligned_share < 1.0 || !(square_m2(span) > 0.0)) continue;
    const double beyond_m2 = span.middle_variance_m2 - span.published_middle_variance_m2;
    samples += span.samples;
    sum_px2 += span.samples * static_cast<double>(span.pixels.size()) * beyond_m2 / square_m2(span);
  }
  if (samples == 0.0) return std::nullopt;
  return std::hypot(kAlignmentFloor_px, std::sqrt(std::max(0.0, sum_px2 / samples)));
}

std::vector<std::string> remarks(const NoiseFit& fit, const NoiseLawSettings& settings) {
  std::vector<std::string> words;
  if (!fit.has_floor) {
    words.push_back(fmt::format(
        "all marks have about {:.0f} pixels, so the law is a guess elsewhere and its floor is 0; "
        "record robots near the camera and far from it, or in good and bad light",
        fit.classes.front().pixels));
  }
  double worst = 1.0;
  double pixels = 0.0;
  for (const PixelClass& each : fit.classes) {
    if (std::abs(std::log(each.law_ratio)) <= std::abs(std::log(worst))) continue;
    worst = each.law_ratio;
    pixels = each.pixels;
  }
  if (!settings.table && std::max(worst, 1.0 / worst) > kGoodRatio) {
    words.push_back(
        fmt::format("at {:.0f} pixels the variance is {:.2f} times the fitted law (a power law "
                    "through the classes has the exponent {:.2f}): --kind table follows it better",
                    pixels, worst, fit.exponent));
  }
  return words;
}

void check_samples(const StandingData& data, const NoiseLawSettings& settings,
                   const std::string& files) {
  const int standing = data.samples - data.moving_samples;
  if (standing >= settings.least_samples) return;
  const int missing = settings.least_samples - standing;
  std::string time;
  if (data.rate_hz > 0.0) {
    time = fmt::format(" ({:.1f} s of one robot)",
                       std::max(missing, 2 * kStandingWindow) / data.rate_hz);
  }
  const bool moves = data.moving_samples >= 2 * kStandingWindow;
  throw vision::InputError(
      {files},
      fmt::format("{} of {} poses are of robots that stand, {} are needed: {} are missing{}",
                  standing, data.samples, settings.least_samples, missing, time),
      moves ? "record robots that nobody drives or touches"
            : "record longer, or more robots at once");
}

}  // namespace

NoiseFit fit_noise(const StandingData& data, const NoiseLawSettings& settings,
                   const std::string& files) {
  check_samples(data, settings, files);
  const std::vector<Evidence> all = evidence(data, settings);
  NoiseFit fit;
  const auto [low, high] = count_range(all);
  fit.has_floor = high >= kFloorFactor * low;
  fit.one_over_n = fit_law(all, fit.has_floor);
  fit.classes = classes(data, settings);
  for (PixelClass& each : fit.classes) {
    each.law_ratio = each.mark_variance_m2.mean() / law_m2(fit.one_over_n, each.pixels);
  }
  fit.exponent = power(fit.classes);
  fit.alignment_floor_px = alignment_floor_px(data);
  double freedom = 0.0;
  for (const Evidence& each : all) freedom += each.degrees_of_freedom;
  fit.relative_error = std::sqrt(2.0 / freedom);
  fit.law = fit.one_over_n;
  if (settings.table) fit.law = table(fit.classes, fit.one_over_n.minimum_pixels);
  fit.remarks = remarks(fit, settings);
  return fit;
}

}  // namespace nadir::calibration
