#include "tracker/evaluation/evaluation.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace nadir::tracker {
namespace {

double distance_m(const LoggedRobot& a, const LoggedRobot& b) {
  return (a.pose_world_robot.position_m() - b.pose_world_robot.position_m()).norm();
}

PoseError pose_error(const LoggedRobot& report, const LoggedRobot& truth) {
  return {fusion::pose_difference(report.pose_world_robot, truth.pose_world_robot),
          report.centre_px - truth.centre_px, report.covariance};
}

struct Pair {
  std::size_t report = 0;
  std::size_t truth = 0;
};

/// Takes pairs out of one frame; every report and every true robot belongs to one pair at most.
class FramePairing {
 public:
  FramePairing(const LoggedFrame& truth, const LoggedFrame& poses, double radius_m)
      : truth_(truth),
        poses_(poses),
        radius_m_(radius_m),
        report_taken_(poses.robots.size()),
        truth_taken_(truth.robots.size()) {}

  /// The nearest pairs first among those that `may_pair` allows.
  template <typename MayPair>
  std::vector<Pair> take_nearest(const MayPair& may_pair) {
    std::vector<std::pair<double, Pair>> candidates;
    for (std::size_t r = 0; r < poses_.robots.size(); ++r) {
      for (std::size_t t = 0; t < truth_.robots.size(); ++t) {
        const double distance = distance_m(poses_.robots[r], truth_.robots[t]);
        if (distance <= radius_m_ && may_pair(poses_.robots[r], truth_.robots[t])) {
          candidates.push_back({distance, {r, t}});
        }
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Pair> pairs;
    for (const auto& [distance, pair] : candidates) {
      if (report_taken_[pair.report] || truth_taken_[pair.truth]) continue;
      report_taken_[pair.report] = truth_taken_[pair.truth] = true;
      pairs.push_back(pair);
    }
    return pairs;
  }

  std::size_t reports_left() const {
    return static_cast<std::size_t>(std::count(report_taken_.begin(), report_taken_.end(), false));
  }

 private:
  const LoggedFrame& truth_;
  const LoggedFrame& poses_;
  double radius_m_;
  std::vector<bool> report_taken_;
  std::vector<bool> truth_taken_;
};

/// Judges one frame after the other; remembers which track number an anonymous robot had.
class Judge {
 public:
  explicit Judge(const EvaluationOptions& options) : options_(options) {}

  void judge(const LoggedFrame& truth, const LoggedFrame& poses) {
    FramePairing pairing(truth, poses, options_.radius_m);
    const auto same_name = [this](const LoggedRobot& report, const LoggedRobot& robot) {
      return report.team == robot.team && (options_.anonymous || report.id == robot.id);
    };
    for (const Pair& pair : pairing.take_nearest(same_name)) {
      take(poses.robots[pair.report], truth.robots[pair.truth]);
    }
    const auto anybody = [](const LoggedRobot&, const LoggedRobot&) { return true; };
    result.wrong_names += pairing.take_nearest(anybody).size();
    result.false_robots += pairing.reports_left();
  }

  Evaluation result;

 private:
  void take(const LoggedRobot& report, const LoggedRobot& robot) {
    const Evaluation::RobotName name{robot.team, robot.id};
    if (options_.anonymous) {
      const auto [last, is_new] = last_track_.try_emplace(name, report.id);
      if (!is_new && last->second != report.id) {
        last->second = report.id;
        ++result.wrong_names;
        return;
      }
    }
    ++result.found;
    result.errors[name].push_back(pose_error(report, robot));
  }

  EvaluationOptions options_;
  std::map<Evaluation::RobotName, int> last_track_;
};

}  // namespace

Evaluation evaluate(const std::vector<LoggedFrame>& truth, const std::vector<LoggedFrame>& poses,
                    const EvaluationOptions& options) {
  std::map<std::uint64_t, const LoggedFrame*> reported;
  for (const LoggedFrame& frame : poses) reported[frame.frame] = &frame;

  Judge judge(options);
  std::size_t frames_reported = 0;
  const LoggedFrame nothing_reported;
  for (const LoggedFrame& frame : truth) {
    const auto match = reported.find(frame.frame);
    if (match != reported.end()) ++frames_reported;
    judge.judge(frame, match == reported.end() ? nothing_reported : *match->second);
    judge.result.true_robots += frame.robots.size();
  }
  judge.result.frames = truth.size();
  judge.result.frames_without_truth = reported.size() - frames_reported;
  return std::move(judge.result);
}

Reception judge_reception(const std::vector<LoggedFrame>& poses,
                          const std::vector<ReceivedPose>& received) {
  using Key = std::tuple<std::uint64_t, std::string, int>;
  Reception reception;
  std::set<Key> arrived;
  std::set<std::uint64_t> frames;
  std::vector<double> latencies_us;
  for (const ReceivedPose& pose : received) {
    arrived.insert({pose.frame, pose.team, pose.id});
    frames.insert(pose.frame);
    latencies_us.push_back(static_cast<double>(pose.receive_ns - pose.publish_ns) * 1e-3);
  }
  for (const LoggedFrame& frame : poses) {
    for (const LoggedRobot& robot : frame.robots) {
      ++reception.logged;
      if (!arrived.contains({frame.frame, robot.team, robot.id})) ++reception.lost;
    }
  }
  reception.received = received.size();
  reception.latency_p50_us = percentile(latencies_us, 0.5);
  reception.latency_p99_us = percentile(latencies_us, 0.99);
  const double duration_s =
      received.empty()
          ? 0.0
          : static_cast<double>(received.back().receive_ns - received.front().receive_ns) * 1e-9;
  if (duration_s > 0.0) {
    reception.frame_rate_hz = static_cast<double>(frames.size() - 1) / duration_s;
  }
  return reception;
}

}  // namespace nadir::tracker
