#include "control_client/drive/drive_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

namespace nadir::control_client {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Sums of one kind of error.
class Sums {
 public:
  void add(const fusion::PlanarPose& is, const fusion::PlanarPose& should_be) {
    const Eigen::Vector3d error = fusion::pose_difference(is, should_be);
    const double square_m2 = error.head<2>().squaredNorm();
    position_m2_ += square_m2;
    heading_rad2_ += error.z() * error.z();
    largest_m2_ = std::max(largest_m2_, square_m2);
    ++count_;
  }
  DriveError error() const {
    if (count_ == 0) return {};
    return {std::sqrt(position_m2_ / count_), std::sqrt(largest_m2_),
            std::sqrt(heading_rad2_ / count_)};
  }

 private:
  double position_m2_ = 0.0;
  double heading_rad2_ = 0.0;
  double largest_m2_ = 0.0;
  int count_ = 0;
};

nlohmann::json json(const DriveError& error) {
  return {{"position_rms_m", error.position_rms_m},
          {"position_max_m", error.position_max_m},
          {"heading_rms_rad", error.heading_rms_rad}};
}

}  // namespace

DriveErrors measure_drive(const DriveRecord& record, double from_s) {
  DriveErrors errors;
  errors.name = record.name;
  Sums fused;
  Sums encoders;
  Sums tracking;
  for (const DriveRow& row : record.rows) {
    if (row.time_s < from_s) continue;
    fused.add(row.estimate, row.truth);
    encoders.add(row.encoders, row.truth);
    if (row.follows) tracking.add(row.truth, row.command);
  }
  // The client stops its robot before it ends: that is not counted.
  const auto last_driven = std::ranges::find_if(record.rows.rbegin(), record.rows.rend(),
                                                [](const DriveRow& row) { return row.drives; });
  for (auto row = record.rows.begin(); row < last_driven.base(); ++row) {
    if (!row->slowed) continue;
    const auto before = row == record.rows.begin() ? row : std::prev(row);
    errors.slowed_s += row->time_s - before->time_s;
  }
  errors.duration_s = record.rows.back().time_s - record.rows.front().time_s;
  errors.fused = fused.error();
  errors.encoders = encoders.error();
  errors.tracking = tracking.error();
  errors.ticks = static_cast<double>(record.rows.size());
  errors.ticks_missed = record.rows.back().ticks_missed;
  return errors;
}

std::string error_table(const std::vector<DriveErrors>& drives) {
  std::string table = fmt::format(
      "{:<20} {:>6} | {:>22} | {:>22} | {:>22} |\n{:<20} {:>6} | {:>7} {:>6} {:>7} | {:>7} {:>6} "
      "{:>7} | {:>7} {:>6} {:>7} | {:>6} {:>7}\n",
      "", "", "fused - true", "encoders alone - true", "true - commanded", "drive", "s", "mm rms",
      "max", "deg", "mm rms", "max", "deg", "mm rms", "max", "deg", "missed", "slow, s");
  const auto cells = [](const DriveError& error) {
    return fmt::format(" | {:7.2f} {:6.1f} {:7.2f}", 1e3 * error.position_rms_m,
                       1e3 * error.position_max_m, kDegrees * error.heading_rms_rad);
  };
  for (const DriveErrors& each : drives) {
    table += fmt::format("{:<20} {:6.1f}{}{}{} | {:6.0f} {:7.1f}\n", each.name, each.duration_s,
                         cells(each.fused), cells(each.encoders), cells(each.tracking),
                         each.ticks_missed, each.slowed_s);
  }
  return table;
}

nlohmann::json error_json(const std::vector<DriveErrors>& drives) {
  nlohmann::json all = nlohmann::json::array();
  for (const DriveErrors& each : drives) {
    all.push_back({{"name", each.name},
                   {"duration_s", each.duration_s},
                   {"fused", json(each.fused)},
                   {"encoders", json(each.encoders)},
                   {"tracking", json(each.tracking)},
                   {"slowed_s", each.slowed_s},
                   {"ticks", each.ticks},
                   {"ticks_missed", each.ticks_missed}});
  }
  return all;
}

}  // namespace nadir::control_client
