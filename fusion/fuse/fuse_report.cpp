#include "fusion/fuse/fuse_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vision/input/number_text.h"

namespace nadir::fusion {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMsPerS = 1000.0;
constexpr double kMmPerM = 1000.0;
constexpr double kDegPerRad = 57.295779513082320877;

/// In the order of PoseVerdict.
constexpr std::array<const char*, kPoseVerdicts> kPoseKeys = {"started",
                                                              "accepted",
                                                              "recovered",
                                                              "reset",
                                                              "gated",
                                                              "waits_for_odometry",
                                                              "duplicate",
                                                              "too_old",
                                                              "from_the_future",
                                                              "before_odometry",
                                                              "no_room",
                                                              "zero_stamp",
                                                              "not_finite",
                                                              "covariance_not_symmetric",
                                                              "covariance_not_positive"};

/// In the order of OdometryVerdict.
constexpr std::array<const char*, kOdometryVerdicts> kOdometryKeys = {
    "used",  "used_after_gap", "clock_restarted", "behind",    "ahead",
    "empty", "too_long",       "zero_stamp",      "not_finite"};

std::string number(double value) {
  return std::isfinite(value) ? vision::text_from_number(value) : "nan";
}

template <std::size_t N>
Json counts_json(const std::array<const char*, N>& keys,
                 const std::array<std::uint64_t, N>& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < N; ++i) {
    if (counts.at(i) > 0) json[keys.at(i)] = counts.at(i);
  }
  return json;
}

/// Verdicts that say something of the row, not of the robot.
bool is_refusal(PoseVerdict verdict) {
  return !is_used(verdict) && verdict != PoseVerdict::kGated &&
         verdict != PoseVerdict::kWaitsForOdometry;
}

std::string refusal_lines(const FuseRun& run, const std::string& vision_file) {
  std::array<int, kPoseVerdicts> counts{};
  std::array<int, kPoseVerdicts> first_lines{};
  for (const VisionDecision& decision : run.decisions) {
    if (!is_refusal(decision.correction.verdict)) continue;
    const auto kind = static_cast<std::size_t>(decision.correction.verdict);
    if (counts.at(kind)++ == 0) first_lines.at(kind) = decision.line;
  }
  std::string text;
  for (std::size_t kind = 0; kind < kPoseVerdicts; ++kind) {
    if (counts.at(kind) == 0) continue;
    text += fmt::format("{}:{}: {} ({} such row{})\n", vision_file, first_lines.at(kind),
                        description(static_cast<PoseVerdict>(kind)), counts.at(kind),
                        counts.at(kind) == 1 ? "" : "s");
  }
  return text;
}

/// Where vision and odometry disagree about time by more than chance and a hundredth of a second.
std::string lag_line(const std::optional<LagReading>& lag) {
  if (!lag || std::abs(lag->lag_s) < std::max(0.01, 3.0 * lag->sigma_s)) return "";
  return fmt::format(
      "vision sees the motion {:+.0f} ms (sigma {:.0f} ms) after odometry tells it: add that to "
      "lead_s of odometry if it is commands, else to undeclared_delay_s of vision\n",
      lag->lag_s * kMsPerS, lag->sigma_s * kMsPerS);
}

std::uint64_t unused_odometry(const FusionHealth& health) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < kOdometryVerdicts; ++i) {
    if (!is_used(static_cast<OdometryVerdict>(i))) count += health.odometry.at(i);
  }
  return count;
}

}  // namespace

std::string estimates_csv(const std::vector<EstimateRow>& rows) {
  std::string text = "t_s,x_m,y_m,heading_rad,cov_xx,cov_xy,cov_xh,cov_yy,cov_yh,cov_hh\n";
  for (const EstimateRow& row : rows) {
    text += number(row.t_s);
    if (row.estimate) {
      const PlanarPose& pose = row.estimate->pose;
      const PoseCovariance& p = row.estimate->covariance;
      for (const double value : {pose.x_m, pose.y_m, pose.heading_rad, p(0, 0), p(0, 1), p(0, 2),
                                 p(1, 1), p(1, 2), p(2, 2)}) {
        text += "," + number(value);
      }
    } else {
      text += ",nan,nan,nan,nan,nan,nan,nan,nan,nan";
    }
    text += "\n";
  }
  return text;
}

std::string summary_json(const FuseRun& run, const std::optional<FuseScore>& score) {
  const VisionCounts counts = count_vision(run.health);
  const bool is_scored = score && score->compared > 0;
  Json json;
  json["position_rms_m"] = is_scored ? Json(score->position_rms_m) : Json();
  json["heading_rms_rad"] = is_scored ? Json(score->heading_rms_rad) : Json();
  json["nees"] = is_scored ? Json(score->nees) : Json();
  json["nis"] = mean_nis(run.decisions);
  json["accepted"] = counts.accepted;
  json["rejected"] = counts.rejected;
  json["recovered"] = counts.recovered;
  json["position_max_m"] = is_scored ? Json(score->position_max_m) : Json();
  json["rows"] = run.estimates.size();
  json["rows_with_truth"] = score ? score->compared : 0;
  json["lag_s"] = run.lag ? Json(run.lag->lag_s) : Json();
  json["lag_sigma_s"] = run.lag ? Json(run.lag->sigma_s) : Json();
  json["not_arrived"] = run.not_arrived;
  json["revised"] = run.health.revised;
  json["poses"] = counts_json(kPoseKeys, run.health.poses);
  json["odometry"] = counts_json(kOdometryKeys, run.health.odometry);
  return json.dump(2) + "\n";
}

std::string score_text(const FuseScore& score) {
  if (score.compared == 0) return "no estimate has truth at its time\n";
  return fmt::format(
      "position RMS {:.2f} mm (largest {:.1f} mm), heading RMS {:.2f} deg, NEES {:.2f} (3 is "
      "honest) at {} rows\n",
      score.position_rms_m * kMmPerM, score.position_max_m * kMmPerM,
      score.heading_rms_rad * kDegPerRad, score.nees, score.compared);
}

std::string summary_text(const FuseRun& run, const std::optional<FuseScore>& score,
                         const std::string& vision_file) {
  const VisionCounts counts = count_vision(run.health);
  std::string text;
  if (score) text += score_text(*score);
  text += fmt::format("{} poses accepted (NIS {:.2f}), {} rejected, {} recovered", counts.accepted,
                      mean_nis(run.decisions), counts.rejected, counts.recovered);
  if (run.not_arrived > 0) text += fmt::format("; {} arrive after the odometry", run.not_arrived);
  text += "\n" + refusal_lines(run, vision_file);
  text += lag_line(run.lag);
  if (const auto unused = unused_odometry(run.health); unused > 0) {
    text += fmt::format("{} odometry rows could not be used; --json tells why\n", unused);
  }
  return text;
}

}  // namespace nadir::fusion
