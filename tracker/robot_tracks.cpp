#include "tracker/robot_tracks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

namespace nadir::tracker {
namespace {

constexpr int kNobody = -1;
constexpr int kReadingsToEstablish = 3;
constexpr int kLeapRank = 2;
constexpr double kVoteMemory = 0.8;  // per frame: four equal frames outvote all that was before
constexpr double kGateSigmas = 3.0;
// Motion is carried on for this long at most: a robot that is out of sight for longer may have
// turned.
constexpr double kLongestPrediction_s = 0.2;

double seconds(vision::CaptureTime::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

// Largest eigenvalue of the position block or a little above: its trace.
double position_variance_m2(const fusion::PoseCovariance& covariance) {
  return covariance(0, 0) + covariance(1, 1);
}

}  // namespace

bool RobotTracks::Track::is_established() const {
  return agreeing_readings >= kReadingsToEstablish;
}

// Older votes fade, the new one is added, and the number with most votes is the track's.
void RobotTracks::Track::vote(int read_id, double weight) {
  for (Vote& vote : votes) vote.weight *= kVoteMemory;
  auto place = std::ranges::find(votes, read_id, &Vote::id);
  if (place == votes.end()) {
    place = std::ranges::min_element(votes, {}, &Vote::weight);
    *place = {read_id, 0.0};
  }
  place->weight += weight;
  const int voted = std::ranges::max_element(votes, {}, &Vote::weight)->id;
  if (voted != id) {
    id = voted;
    agreeing_readings = 0;
  }
  if (read_id == id) ++agreeing_readings;
}

RobotTracks::RobotTracks(const TrackSettings& settings) : settings_(settings) {
  tracks_.reserve(256);
  pairs_.reserve(1024);
  track_of_candidate_.reserve(64);
  track_taken_.reserve(256);
  decisions_.reserve(64);
}

std::span<const TrackDecision> RobotTracks::update(vision::CaptureTime capture_time,
                                                   std::span<const TrackCandidate> candidates) {
  forget_lost(capture_time);
  expect_motion(capture_time);
  mark_contradicted(candidates);
  list_pairs(capture_time, candidates);
  assign_pairs(capture_time, candidates);
  decide_numbers(candidates);
  settle_duplicates(candidates);
  last_update_ = capture_time;
  return decisions_;
}

void RobotTracks::forget_lost(vision::CaptureTime now) {
  if (now < last_update_) {
    tracks_.clear();
    numbers_.clear();
  }
  std::erase_if(tracks_, [&](const Track& track) {
    const bool superseded = track.contradicted && track.last_seen < last_update_;
    if (!superseded && seconds(now - track.last_seen) <= settings_.lost_after_s) return false;
    if (track.anonymous) numbers_.give_back(track.id, now);
    return true;
  });
}

void RobotTracks::expect_motion(vision::CaptureTime now) {
  for (Track& track : tracks_) {
    const double ahead_s = std::min(seconds(now - track.last_seen), kLongestPrediction_s);
    track.expected_m = track.pose.position_m() + track.velocity_mps * ahead_s;
  }
}

// An established track must not hold its number against another reading if that number is read
// elsewhere: the robots were moved, or the recording was cut. (If nobody continues the track then,
// it is forgotten with the next frame.) The reading elsewhere does not count if it is itself a
// flicker: on the place of another established track whose own number is read nowhere else.
void RobotTracks::mark_contradicted(std::span<const TrackCandidate> candidates) {
  const auto stands_on = [&](const TrackCandidate& candidate, const Track& track) {
    const Eigen::Vector2d away = candidate.pose_world_robot.position_m() - track.expected_m;
    return candidate.kind == track.kind && away.norm() <= settings_.same_place_m;
  };
  const auto read_elsewhere = [&](const TrackCandidate& candidate, const Track& track) {
    return candidate.kind == track.kind && candidate.read_id == track.id &&
           candidate.confidence >= settings_.confident_reading && !stands_on(candidate, track);
  };
  const auto may_hold = [](const Track& track) {
    return !track.anonymous && track.is_established();
  };
  for (Track& track : tracks_) {
    track.read_elsewhere =
        may_hold(track) && std::ranges::any_of(candidates, [&](const auto& candidate) {
          return read_elsewhere(candidate, track);
        });
  }
  const auto flickers = [&](const TrackCandidate& candidate) {
    return std::ranges::any_of(tracks_, [&](const Track& track) {
      return may_hold(track) && !track.read_elsewhere && stands_on(candidate, track);
    });
  };
  for (Track& track : tracks_) {
    track.contradicted =
        track.read_elsewhere && std::ranges::any_of(candidates, [&](const auto& candidate) {
          return read_elsewhere(candidate, track) && !flickers(candidate);
        });
  }
}

// All pairs within reach. Rank 0: same number at the same place; 1: another number at the same
// place; kLeapRank: same number within reach. Anonymous robots have rank 0 throughout.
void RobotTracks::list_pairs(vision::CaptureTime now, std::span<const TrackCandidate> candidates) {
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    const double unseen_s = seconds(now - track.last_seen);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const TrackCandidate& candidate = candidates[c];
      if (candidate.kind != track.kind) continue;
      const Eigen::Vector2d position = candidate.pose_world_robot.position_m();
      const double sigma_m =
          std::sqrt(position_variance_m2(candidate.covariance) + track.position_variance_m2);
      const double reach_m = settings_.speed_limit_mps * unseen_s + kGateSigmas * sigma_m;
      if ((position - track.pose.position_m()).norm() > reach_m) continue;
      const double distance_m = (position - track.expected_m).norm();
      const bool same_place = distance_m <= settings_.same_place_m + kGateSigmas * sigma_m;
      const bool same_number = track.anonymous || candidate.read_id == track.id;
      if (!same_number && (!same_place || track.contradicted)) continue;
      const int rank = track.anonymous || (same_number && same_place) ? 0
                       : same_place                                   ? 1
                                                                      : kLeapRank;
      pairs_.push_back({rank, distance_m, static_cast<int>(c), static_cast<int>(t)});
    }
  }
  std::ranges::sort(pairs_, {}, [](const Pair& pair) {
    return std::tuple(pair.rank, pair.distance_m, pair.candidate, pair.track);
  });
}

void RobotTracks::assign_pairs(vision::CaptureTime now,
                               std::span<const TrackCandidate> candidates) {
  track_of_candidate_.assign(candidates.size(), kNobody);
  track_taken_.assign(tracks_.size(), 0);
  for (const Pair& pair : pairs_) {
    int& owner = track_of_candidate_[static_cast<std::size_t>(pair.candidate)];
    char& taken = track_taken_[static_cast<std::size_t>(pair.track)];
    if (owner != kNobody || taken != 0) continue;
    owner = pair.track;
    taken = 1;
    Track& track = tracks_[static_cast<std::size_t>(pair.track)];
    // A leap is not following: whatever was read before it has no say after it.
    if (pair.rank == kLeapRank) track.agreeing_readings = 0;
    continue_track(now, candidates[static_cast<std::size_t>(pair.candidate)], track);
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (track_of_candidate_[c] == kNobody) start_track(now, candidates[c], static_cast<int>(c));
  }
}

void RobotTracks::start_track(vision::CaptureTime now, const TrackCandidate& candidate, int index) {
  track_of_candidate_[static_cast<std::size_t>(index)] = static_cast<int>(tracks_.size());
  Track& track = tracks_.emplace_back();
  track.kind = candidate.kind;
  track.anonymous = candidate.read_id < 0;
  if (track.anonymous)
    track.id = numbers_.take(now);
  else
    track.vote(candidate.read_id, candidate.confidence);
  track.pose = candidate.pose_world_robot;
  track.position_variance_m2 = position_variance_m2(candidate.covariance);
  track.last_seen = now;
}

void RobotTracks::continue_track(vision::CaptureTime now, const TrackCandidate& candidate,
                                 Track& track) {
  const double unseen_s = seconds(now - track.last_seen);
  if (unseen_s > 0.0) {
    track.velocity_mps =
        (candidate.pose_world_robot.position_m() - track.pose.position_m()) / unseen_s;
  }
  if (!track.anonymous) track.vote(candidate.read_id, candidate.confidence);
  track.pose = candidate.pose_world_robot;
  track.position_variance_m2 = position_variance_m2(candidate.covariance);
  track.last_seen = now;
}

void RobotTracks::decide_numbers(std::span<const TrackCandidate> candidates) {
  decisions_.assign(candidates.size(), {});
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Track& track = tracks_[static_cast<std::size_t>(track_of_candidate_[c])];
    TrackDecision& decision = decisions_[c];
    decision.id = track.anonymous || track.is_established() ? track.id : candidates[c].read_id;
    const bool first_sight = !track.anonymous && track.agreeing_readings < 2;
    if (first_sight && candidates[c].confidence < settings_.confident_reading) {
      decision.verdict = TrackDecision::Verdict::kUncertain;
    }
  }
}

void RobotTracks::settle_duplicates(std::span<const TrackCandidate> candidates) {
  const auto track_of = [&](std::size_t c) -> Track& {
    return tracks_[static_cast<std::size_t>(track_of_candidate_[c])];
  };
  const auto claim = [&](std::size_t c) {
    const Track& track = track_of(c);
    const bool continues =
        track.held_number && track.is_established() && track.id == decisions_[c].id;
    return std::tuple(continues, candidates[c].confidence);
  };
  const auto reported = [&](std::size_t c) {
    return decisions_[c].verdict == TrackDecision::Verdict::kReport && candidates[c].read_id >= 0;
  };
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = a + 1; b < candidates.size() && reported(a); ++b) {
      if (!reported(b) || candidates[a].kind != candidates[b].kind ||
          decisions_[a].id != decisions_[b].id) {
        continue;
      }
      decisions_[claim(b) > claim(a) ? a : b].verdict = TrackDecision::Verdict::kDuplicate;
    }
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) track_of(c).held_number = reported(c);
}

}  // namespace nadir::tracker
