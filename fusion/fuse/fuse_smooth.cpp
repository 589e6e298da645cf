#include "fusion/fuse/fuse_smooth.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "fusion/smoother.h"

namespace nadir::fusion {
namespace {

/// Something that happens at a time: new rates, a frame, a row that wants its pose.
struct Event {
  enum class Kind : std::uint8_t { kRates, kFrame, kRow };
  double t_s = 0.0;
  Kind kind = Kind::kRow;
  std::size_t index = 0;

  bool operator<(const Event& other) const {
    if (t_s != other.t_s) return t_s < other.t_s;
    // Frames are used before the row of the same time is written.
    return kind < other.kind;
  }
};

/// In the order of time; odometry rows whose stamp jumps back are left out.
std::vector<Event> events_of(const FuseLogs& logs, const FuseConfig& config) {
  std::vector<Event> events;
  double latest_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < logs.odometry.size(); ++i) {
    const OdometryRow& row = logs.odometry[i];
    if (row.t_s <= latest_s) continue;
    latest_s = row.t_s;
    events.push_back({row.t_s, Event::Kind::kRow, i});
    if (row.rates.is_finite()) {
      events.push_back({row.t_s + config.odometry_lead_s, Event::Kind::kRates, i});
    }
  }
  const double first_s = logs.odometry.front().t_s;
  for (std::size_t i = 0; i < logs.vision.size(); ++i) {
    const double t_s = logs.vision[i].t_capture_s - config.vision_undeclared_delay_s;
    if (t_s >= first_s && t_s <= latest_s) events.push_back({t_s, Event::Kind::kFrame, i});
  }
  std::stable_sort(events.begin(), events.end());
  return events;
}

bool is_same_frame(const VisionRow& a, const VisionRow& b) {
  return a.t_capture_s == b.t_capture_s && a.pose.x_m == b.pose.x_m && a.pose.y_m == b.pose.y_m &&
         a.pose.heading_rad == b.pose.heading_rad;
}

/// Drives the smoother through the events and marks the odometry rows.
class LogSmoother {
 public:
  LogSmoother(const FuseLogs& logs, const FuseConfig& config)
      : logs_(logs),
        longest_s_(std::chrono::duration<double>(config.odometry_check.longest_interval).count()),
        smoother_(settings_of(config)),
        now_s_(logs.odometry.front().t_s),
        rates_until_s_(now_s_ + longest_s_) {
    if (logs.odometry.front().rates.is_finite()) rates_ = logs.odometry.front().rates;
    if (!config.start) return;
    const Eigen::Vector3d sigmas(config.start->sigma_m, config.start->sigma_m,
                                 config.start->sigma_rad);
    smoother_.start(config.start->pose, sigmas.cwiseAbs2().asDiagonal());
  }

  void take(const Event& event) {
    move_to(event.t_s);
    if (event.kind == Event::Kind::kRates) {
      rates_ = logs_.odometry[event.index].rates;
      rates_until_s_ = event.t_s + longest_s_;
    } else if (event.kind == Event::Kind::kFrame) {
      const VisionRow& frame = logs_.vision[event.index];
      if (last_frame_ == nullptr || !is_same_frame(frame, *last_frame_)) {
        smoother_.correct(frame.pose, frame.covariance());
      }
      last_frame_ = &frame;
    } else {
      smoother_.mark();
      marked_rows_.push_back(event.index);
    }
  }

  std::vector<EstimateRow> rows() const {
    std::vector<EstimateRow> rows;
    for (const OdometryRow& row : logs_.odometry) rows.push_back({row.t_s, std::nullopt});
    const auto poses = smoother_.smooth();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!poses[i]) continue;
      rows[marked_rows_[i]].estimate =
          Estimate{Timestamp{0}, poses[i]->pose, poses[i]->covariance, {}};
    }
    return rows;
  }

 private:
  static Smoother<>::Filter::Settings settings_of(const FuseConfig& config) {
    Smoother<>::Filter::Settings settings;
    settings.gate = config.gate;
    settings.recovery = config.recovery;
    settings.gap = config.gap;
    settings.odometry_error = config.walk.noise();
    return settings;
  }

  void move_to(double t_s) {
    const double dt_s = t_s - now_s_;
    if (dt_s <= 0.0) return;
    if (now_s_ < rates_until_s_) {
      smoother_.predict({rates_, rates_, dt_s, dt_s});
    } else {
      smoother_.predict_gap(rates_, dt_s);
    }
    now_s_ = t_s;
  }

  const FuseLogs& logs_;
  double longest_s_;
  Smoother<> smoother_;
  double now_s_;
  BodyRates rates_;
  double rates_until_s_;
  const VisionRow* last_frame_ = nullptr;
  std::vector<std::size_t> marked_rows_;
};

}  // namespace

std::vector<EstimateRow> smooth(const FuseLogs& logs, const FuseConfig& config) {
  LogSmoother smoother(logs, config);
  for (const Event& event : events_of(logs, config)) smoother.take(event);
  return smoother.rows();
}

}  // namespace nadir::fusion
