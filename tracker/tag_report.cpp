#include "tracker/tag_report.h"

namespace nadir::tracker {

TrackCandidate track_candidate(const TagRobot& robot, int kind) {
  return {.kind = kind,
          .read_id = robot.id,
          .pose_world_robot = robot.pose.pose_world_robot,
          .covariance = robot.pose.covariance,
          .confidence = robot.confidence};
}

RobotReport robot_report(const TagRobot& robot, int id, std::string_view team) {
  RobotReport report;
  report.id = id;
  report.team = team;
  report.pose_world_robot = robot.pose.pose_world_robot;
  report.covariance = robot.pose.covariance;
  report.centre_px = robot.pose.centre_px;
  report.pixels = robot.pixels;
  report.marker_count = robot.tag_count;
  report.confidence = robot.confidence;
  report.aligned = robot.aligned;
  return report;
}

}  // namespace nadir::tracker
