#pragma once

// The functions of EkfSlam for sightings with names; included by its header alone.

#include <cassert>

#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::judge_named(std::span<const Sighting> sightings,
                                                      std::span<SightingReport> reports) const {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    SightingReport& report = reports[i];
    if (refuse(sightings[i], i, report)) continue;
    report.landmark = index_of(sightings[i].name);
    report.verdict = SightingVerdict::kNew;
    if (report.landmark < 0) continue;
    const Comparison comparison = compare(sightings[i], report.landmark);
    report.innovation = comparison.innovation;
    report.nis = nis(comparison, report.landmark);
    report.verdict =
        report.nis <= settings_.sighting_gate ? SightingVerdict::kUsed : SightingVerdict::kGated;
  }
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
bool EkfSlam<OdometryError, SensorError>::is_lost(std::span<const SightingReport> reports) {
  int used = 0;
  int gated = 0;
  for (const SightingReport& report : reports) {
    used += report.verdict == SightingVerdict::kUsed ? 1 : 0;
    gated += report.verdict == SightingVerdict::kGated ? 1 : 0;
  }
  if (used + gated < 2) return false;  // a single landmark may be what moved
  lost_scans_ = gated > used ? lost_scans_ + 1 : 0;
  if (settings_.lost_after == 0 || lost_scans_ < settings_.lost_after) return false;
  lost_scans_ = 0;
  return true;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::widen_pose() {
  HeadMatrix noise = HeadMatrix::Zero();
  noise.template topLeftCorner<3, 3>() =
      Eigen::Vector3d(settings_.lost_sigma_m, settings_.lost_sigma_m, settings_.lost_sigma_rad)
          .cwiseAbs2()
          .asDiagonal();
  covariance_.predict(HeadMatrix::Identity(), noise);
  covariance_.catch_up();
  ++recoveries_;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::observe(std::span<const Sighting> sightings,
                                                  std::span<SightingReport> reports) {
  assert(reports.size() == sightings.size());
  covariance_.catch_up();
  judge_named(sightings, reports);
  if (is_lost(reports)) {
    widen_pose();
    judge_named(sightings, reports);
  }
  correct_by_used(sightings, reports);
  add_new(sightings, reports, true);
}

}  // namespace nadir::fusion
