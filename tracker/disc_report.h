#pragma once

#include "tracker/disc_robots.h"
#include "tracker/pose_report.h"
#include "tracker/robot_tracks.h"
#include "vision/marker_layout.h"

namespace nadir::tracker {

/// A robot with discs in the words of RobotTracks. `first_kind`: of its layout's first team.
TrackCandidate track_candidate(const DiscRobot& robot, const vision::MarkerLayout& layout,
                               int first_kind);

/// The same in the words of a report. `layout` must live as long as the report.
RobotReport robot_report(const DiscRobot& robot, int id, const vision::MarkerLayout& layout);

}  // namespace nadir::tracker
