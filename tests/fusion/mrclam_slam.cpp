#include "tests/fusion/mrclam_slam.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

namespace nadir::fusion {
namespace {

std::vector<std::vector<double>> read_table(const std::string& name) {
  std::ifstream stream(mrclam_folder() / name);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (double word = 0.0; words >> word;) rows.back().push_back(word);
  }
  return rows;
}

/// Plays one recording.
class Run {
 public:
  Run(int robot, const MrclamSlamProtocol& protocol)
      : protocol_(protocol),
        recording_(load_mrclam_sightings(robot)),
        feed_(load_mrclam(robot, feed_protocol(protocol))),
        slam_(protocol.settings) {}

  MrclamSlamResult result() {
    const double start_s = first_truth_s();
    PlanarPose start;
    truth_at(feed_.truth, start_s, 0.35, &start);
    slam_.start(start, Eigen::Vector3d(1e-6, 1e-6, 1e-5).asDiagonal());
    now_s_ = start_s;
    const auto& rows = feed_.odometry;
    while (row_ + 1 < rows.size() && rows[row_ + 1].t_s <= now_s_) ++row_;
    auto sighting = recording_.sightings.cbegin();
    auto vision = feed_.vision.begin();
    double score_s = start_s + 1.0;
    while (sighting != recording_.sightings.end() && sighting->t_s < start_s) ++sighting;
    while (vision != feed_.vision.end() && vision->t_capture_s < start_s) ++vision;
    while (score_s < protocol_.start_s + protocol_.duration_s) {
      const double sighting_s = sighting == recording_.sightings.end() ? 1e9 : sighting->t_s;
      const double vision_s = protocol_.vision_period_s > 0.0 && vision != feed_.vision.end()
                                  ? vision->t_capture_s
                                  : 1e9;
      if (score_s <= std::min(sighting_s, vision_s)) {
        predict_to(score_s);
        score(score_s);
        score_s += 1.0;
      } else if (vision_s <= sighting_s) {
        predict_to(vision_s);
        slam_.correct(vision->pose,
                      Eigen::Vector3d(vision->var_x_m2, vision->var_y_m2, vision->var_heading_rad2)
                          .asDiagonal());
        ++vision;
      } else {
        predict_to(sighting_s);
        observe(sighting);
      }
    }
    return finish();
  }

 private:
  static MrclamProtocol feed_protocol(const MrclamSlamProtocol& protocol) {
    MrclamProtocol feed;
    feed.delay_s = 0.0;
    if (protocol.vision_period_s > 0.0) feed.rate_hz = 1.0 / protocol.vision_period_s;
    return feed;
  }

  double first_truth_s() const {
    return std::max(feed_.odometry.front().t_s, feed_.truth.front().t_s) + 0.1 + protocol_.start_s;
  }

  void predict_to(double t_s) {
    const auto& rows = feed_.odometry;
    while (now_s_ < t_s - 1e-9) {
      while (row_ + 1 < rows.size() && rows[row_ + 1].t_s <= now_s_ + 1e-9) ++row_;
      const double row_end_s = row_ + 1 < rows.size() ? rows[row_ + 1].t_s : 1e9;
      const double until_s = std::min(t_s, row_end_s);
      const BodyRates& before = rows[row_ > 0 ? row_ - 1 : 0].rates;
      const OdometryStep step{rows[row_].rates, before, row_end_s - rows[row_].t_s,
                              until_s - now_s_};
      slam_.predict(step);
      now_s_ = until_s;
    }
  }

  void observe(std::vector<MrclamSighting>::const_iterator& next) {
    std::vector<Sighting> scan;
    const auto first = next;
    for (; next != recording_.sightings.end() && next->t_s < first->t_s + 0.005; ++next) {
      scan.push_back({next->seen,
                      sighting_covariance(protocol_.sigma_range_m, protocol_.sigma_bearing_rad),
                      next->landmark});
    }
    std::vector<SightingReport> reports(scan.size());
    if (protocol_.knows_names) {
      slam_.observe(scan, reports);
    } else {
      slam_.observe_nameless(scan, reports);
    }
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const SightingReport& report = reports[i];
      used_ += report.verdict == SightingVerdict::kUsed ? 1 : 0;
      result_.gated += report.verdict == SightingVerdict::kGated ? 1 : 0;
      result_.ambiguous += report.verdict == SightingVerdict::kAmbiguous ? 1 : 0;
      if (report.verdict == SightingVerdict::kUsed) nis_sum_ += report.nis;
      if (report.landmark >= 0) ++votes_[report.landmark][scan[i].name];
      seen_[scan[i].name] = true;
    }
  }

  void score(double t_s) {
    PlanarPose truth;
    if (!truth_at(feed_.truth, t_s, 0.35, &truth)) return;
    const Eigen::Vector3d error = pose_difference(slam_.pose(), truth);
    nees_sum_ += error.dot(slam_.pose_covariance().inverse() * error);
    position_sum_ += error.head<2>().squaredNorm();
    heading_sum_ += error.z() * error.z();
    ++scores_;
  }

  /// The barcode that most of a map's landmark's sightings had.
  int true_name(int landmark) const {
    int best = 0;
    int most = 0;
    for (const auto& [name, count] : votes_.at(landmark)) {
      if (count > most) best = name;
      most = std::max(most, count);
    }
    return best;
  }

  MrclamSlamResult finish() {
    const int n = slam_.landmarks();
    Eigen::Matrix2Xd estimated(2, n);
    Eigen::Matrix2Xd surveyed(2, n);
    for (int i = 0; i < n; ++i) {
      estimated.col(i) = slam_.landmark_m(i);
      surveyed.col(i) = recording_.landmarks_m.at(true_name(i));
    }
    result_.landmark_world_rmse_m = std::sqrt((estimated - surveyed).squaredNorm() / n);
    const Eigen::Vector2d from = estimated.rowwise().mean();
    const Eigen::Vector2d to = surveyed.rowwise().mean();
    estimated.colwise() -= from;
    surveyed.colwise() -= to;
    const Eigen::Matrix2d m = surveyed * estimated.transpose();
    const double turn = std::atan2(m(1, 0) - m(0, 1), m(0, 0) + m(1, 1));
    Eigen::Matrix2d rotation;
    rotation << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    result_.landmark_rmse_m = std::sqrt((rotation * estimated - surveyed).squaredNorm() / n);
    result_.landmarks = n;
    result_.landmarks_true = static_cast<int>(seen_.size());
    result_.pose_rms_m = std::sqrt(position_sum_ / scores_);
    result_.heading_rms_rad = std::sqrt(heading_sum_ / scores_);
    result_.nees = nees_sum_ / scores_;
    result_.nis = nis_sum_ / used_;
    result_.used = used_;
    return result_;
  }

  const MrclamSlamProtocol& protocol_;
  MrclamSightings recording_;
  MrclamFeed feed_;
  MrclamSlam slam_;
  double now_s_ = 0.0;
  std::size_t row_ = 0;
  int used_ = 0;
  int scores_ = 0;
  double nis_sum_ = 0.0;
  double nees_sum_ = 0.0;
  double position_sum_ = 0.0;
  double heading_sum_ = 0.0;
  std::map<int, std::map<int, int>> votes_;
  std::map<int, bool> seen_;
  MrclamSlamResult result_;
};

}  // namespace

MrclamSlamProtocol::MrclamSlamProtocol() {
  // Turns of tens of radians between landmarks are no longer linear in a scale that is known to
  // 10 %; odometry's other errors cover what 3 % does not.
  BodyRateErrorParameters odometry;
  odometry.scale_sigma = {0.05, 0.1, 0.03};
  settings.odometry_error = BodyRateError(odometry);
  CameraSensorParameters camera;
  camera.range_scale_sigma = 0.01;
  camera.range_offset_sigma_m = 0.02;
  settings.sensor_error = CameraSensorError(camera);
  settings.most_landmarks = 60;
}

MrclamSightings load_mrclam_sightings(int robot) {
  MrclamSightings result;
  std::map<int, int> subject_of;
  for (const auto& row : read_table("Barcodes.dat")) {
    subject_of[static_cast<int>(row[1])] = static_cast<int>(row[0]);
  }
  for (const auto& row : read_table("Landmark_Groundtruth.dat")) {
    result.landmarks_m[static_cast<int>(row[0])] = {row[1], row[2]};
  }
  const std::string name = "Robot" + std::to_string(robot);
  const double start_s = read_table(name + "_Odometry.dat").front()[0];
  for (const auto& row : read_table(name + "_Measurement.dat")) {
    const auto subject = subject_of.find(static_cast<int>(row[1]));
    if (subject == subject_of.end() || result.landmarks_m.count(subject->second) == 0) continue;
    result.sightings.push_back({row[0] - start_s - kMrclamCameraDelay_s,
                                subject->second,
                                {row[2] / std::cos(row[3]), row[3]}});
  }
  return result;
}

MrclamSlamResult run_mrclam_slam(int robot, const MrclamSlamProtocol& protocol) {
  return Run(robot, protocol).result();
}

}  // namespace nadir::fusion
