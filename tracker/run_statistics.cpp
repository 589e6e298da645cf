#include "tracker/run_statistics.h"

#include <fmt/format.h>

#include <algorithm>

namespace nadir::tracker {
namespace {

double median(const std::vector<StageTimes>& stages, double StageTimes::*stage) {
  if (stages.empty()) return 0.0;
  std::vector<double> values;
  values.reserve(stages.size());
  for (const StageTimes& each : stages) values.push_back(each.*stage);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

void RunStatistics::add(const FrameReport& report) {
  if (stages_.size() < kWindow) {
    stages_.push_back(report.stages);
  } else {
    stages_[frames_ % kWindow] = report.stages;
  }
  ++frames_;
  robots_ += report.robots.size();
  rejected_ += report.rejected.size() + static_cast<std::uint64_t>(report.rejected_not_listed);
}

StageTimes RunStatistics::median_stages() const {
  return {median(stages_, &StageTimes::read_us), median(stages_, &StageTimes::detect_us),
          median(stages_, &StageTimes::map_us), median(stages_, &StageTimes::total_us)};
}

std::string RunStatistics::summary(const std::string& camera) const {
  const double frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
  const StageTimes median_us = median_stages();
  return fmt::format(
      "{}: {} frames, {} skipped, {:.2f} robots and {:.2f} rejected a frame; "
      "median us: read {:.0f}, detect {:.0f}, map {:.0f}, total {:.0f}",
      camera, frames_, skipped_, static_cast<double>(robots_) / frames,
      static_cast<double>(rejected_) / frames, median_us.read_us, median_us.detect_us,
      median_us.map_us, median_us.total_us);
}

}  // namespace nadir::tracker
