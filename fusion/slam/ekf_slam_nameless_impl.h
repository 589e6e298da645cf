#pragma once

// The functions of EkfSlam for sightings without names; included by its header alone.

#include <algorithm>
#include <cassert>

#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
bool EkfSlam<OdometryError, SensorError>::find_candidates(const Sighting& sighting, int index) {
  // Pairs within pair_gate; those within other_gate are remembered too, behind the others' gate,
  // since they forbid a new landmark.
  bool has_room = true;
  for (int landmark = 0; landmark < landmarks(); ++landmark) {
    const Comparison comparison = compare(sighting, landmark);
    const double distance = nis(comparison, landmark);
    if (!(distance <= settings_.other_gate)) continue;
    const int at = candidates_.count;
    has_room = candidates_.add({index, landmark, comparison.innovation, distance});
    if (!has_room) break;
    comparisons_[static_cast<std::size_t>(at)] = comparison;
    for (int other = 0; other <= at; ++other) {
      const auto o = static_cast<std::size_t>(other);
      Eigen::Matrix2d block = innovation_covariance(comparison, landmark, comparisons_[o],
                                                    candidates_.pair[o].landmark);
      if (candidates_.pair[o].sighting == index) block += comparison.noise;
      candidates_.covariance.template block<2, 2>(2 * at, 2 * other) = block;
      candidates_.covariance.template block<2, 2>(2 * other, 2 * at) = block.transpose();
    }
  }
  return has_room;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::judge_unpaired(SightingReport& report, int index,
                                                         const Pairing& pairing) const {
  // A landmark that another sighting of the same scan has taken is not this one: it is new if that
  // is so for all landmarks that it could be.
  report.verdict = SightingVerdict::kNew;
  for (int i = 0; i < candidates_.count; ++i) {
    const Candidate& each = candidates_.pair[static_cast<std::size_t>(i)];
    if (each.sighting != index) continue;
    bool is_taken = false;
    for (const int chosen : pairing) {
      is_taken = is_taken ||
                 (chosen >= 0 &&
                  candidates_.pair[static_cast<std::size_t>(chosen)].landmark == each.landmark);
    }
    if (!is_taken) report.verdict = SightingVerdict::kAmbiguous;
  }
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::observe_nameless(std::span<const Sighting> sightings,
                                                           std::span<SightingReport> reports) {
  assert(reports.size() == sightings.size());
  covariance_.catch_up();
  candidates_.count = 0;
  const int count = static_cast<int>(std::min<std::size_t>(sightings.size(), kMaxSightings));
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (refuse(sightings[i], i, reports[i])) continue;
    reports[i].verdict = SightingVerdict::kAmbiguous;
    if (find_candidates(sightings[i], static_cast<int>(i))) {
      reports[i].verdict = SightingVerdict::kNew;  // until it is paired
    }
  }
  const bool is_joint = settings_.association == AssociationKind::kJointCompatibility;
  const Pairing pairing = is_joint ? joint_compatibility(candidates_, count, settings_.pair_gate)
                                   : nearest_neighbours(candidates_, count, settings_.pair_gate);
  for (int i = 0; i < count; ++i) {
    SightingReport& report = reports[static_cast<std::size_t>(i)];
    if (report.verdict != SightingVerdict::kNew) continue;
    const int chosen = pairing[static_cast<std::size_t>(i)];
    if (chosen < 0) {
      judge_unpaired(report, i, pairing);
      continue;
    }
    const Candidate& pair = candidates_.pair[static_cast<std::size_t>(chosen)];
    report = {SightingVerdict::kUsed, pair.landmark, pair.innovation, pair.distance};
  }
  correct_by_used(sightings, reports);
  add_new(sightings, reports, false);
}

}  // namespace nadir::fusion
