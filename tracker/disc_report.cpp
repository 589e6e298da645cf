#include "tracker/disc_report.h"

#include <cmath>

namespace nadir::tracker {

TrackCandidate track_candidate(const DiscRobot& robot, const vision::MarkerLayout& layout,
                               int first_kind) {
  const vision::RobotObservation& seen = *robot.observation;
  return {.kind = first_kind + seen.team,
          .read_id = layout.is_anonymous()
                         ? -1
                         : layout.identities[static_cast<std::size_t>(seen.identity)].id,
          .pose_world_robot = robot.pose.pose_world_robot,
          .covariance = robot.pose.covariance,
          .confidence = seen.confidence};
}

RobotReport robot_report(const DiscRobot& robot, int id, const vision::MarkerLayout& layout) {
  const vision::RobotObservation& seen = *robot.observation;
  RobotReport report;
  report.id = id;
  report.team = layout.teams[static_cast<std::size_t>(seen.team)].name;
  report.pose_world_robot = robot.pose.pose_world_robot;
  report.covariance = robot.pose.covariance;
  report.centre_px = robot.pose.centre_px;
  report.marker_count = seen.disc_count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(seen.disc_count); ++i) {
    report.pixels[i] = static_cast<int>(std::lround(seen.discs[i].pixels));
  }
  report.confidence = seen.confidence;
  report.aligned = robot.aligned();
  return report;
}

}  // namespace nadir::tracker
