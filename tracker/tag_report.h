#pragma once

#include <string_view>

#include "tracker/pose_report.h"
#include "tracker/robot_tracks.h"
#include "tracker/tag_robots.h"

namespace nadir::tracker {

/// A robot with tags in the words of RobotTracks. `kind`: of its layout.
TrackCandidate track_candidate(const TagRobot& robot, int kind);

/// The same in the words of a report. `team` must live as long as the report.
RobotReport robot_report(const TagRobot& robot, int id, std::string_view team);

}  // namespace nadir::tracker
