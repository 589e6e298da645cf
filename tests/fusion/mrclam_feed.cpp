#include "tests/fusion/mrclam_feed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

namespace nadir::fusion {
namespace {

/// The longest gap of the motion capture that is bridged.
constexpr double kMaxTruthGap_s = 0.05;

/// Rows of `count` numbers; lines with '#' are comments.
std::vector<std::array<double, 4>> read_rows(const std::filesystem::path& file, int count) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::vector<std::array<double, 4>> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::array<double, 4> row{};
    for (int i = 0; i < count; ++i) words >> row.at(static_cast<std::size_t>(i));
    if (!words) throw std::runtime_error("no row of numbers in " + file.string() + ": " + line);
    rows.push_back(row);
  }
  return rows;
}

std::vector<TruthRow> read_truth(const std::filesystem::path& file, double start_s) {
  std::vector<TruthRow> truth;
  for (const auto& row : read_rows(file, 4)) {
    const double t_s = row[0] - start_s;
    if (!truth.empty() && t_s <= truth.back().t_s) continue;
    truth.push_back({t_s, {row[1], row[2], wrap_angle(row[3])}});
  }
  return truth;
}

bool is_dropped(const MrclamProtocol& protocol, double t_s) {
  if (protocol.drop_s <= 0.0) return false;
  const double phase_s = std::fmod(t_s, protocol.drop_every_s);
  return phase_s >= protocol.drop_every_s - protocol.drop_s;
}

std::vector<VisionRow> vision_of(const MrclamFeed& feed, const MrclamProtocol& protocol) {
  std::mt19937_64 random(protocol.seed);
  std::normal_distribution<double> normal;
  std::vector<VisionRow> vision;
  const double end_s = feed.odometry.back().t_s;
  const double var_position_m2 = protocol.sigma_position_m * protocol.sigma_position_m;
  const double var_heading_rad2 = protocol.sigma_heading_rad * protocol.sigma_heading_rad;
  for (int frame = 0; frame / protocol.rate_hz < end_s; ++frame) {
    const double t_s = frame / protocol.rate_hz;
    const double noise_x = normal(random);
    const double noise_y = normal(random);
    const double noise_heading = normal(random);
    PlanarPose pose;
    if (is_dropped(protocol, t_s) || !truth_at(feed.truth, t_s, kMaxTruthGap_s, &pose)) continue;
    pose.x_m += protocol.sigma_position_m * noise_x;
    pose.y_m += protocol.sigma_position_m * noise_y;
    pose.heading_rad = wrap_angle(pose.heading_rad + protocol.sigma_heading_rad * noise_heading);
    vision.push_back({t_s + protocol.undeclared_delay_s, t_s + protocol.delay_s, pose,
                      var_position_m2, var_position_m2, var_heading_rad2, 0});
  }
  return vision;
}

/// Odometry and truth.
MrclamFeed read_recording(int robot) {
  const std::string name = "Robot" + std::to_string(robot);
  const auto rates = read_rows(mrclam_folder() / (name + "_Odometry.dat"), 3);
  if (rates.empty()) throw std::runtime_error("no odometry of " + name);
  const double start_s = rates.front()[0];
  MrclamFeed feed;
  for (const auto& row : rates) {
    const double t_s = row[0] - start_s;
    if (!feed.odometry.empty() && t_s <= feed.odometry.back().t_s) continue;
    feed.odometry.push_back({t_s, {row[1], 0.0, row[2]}, 0});
  }
  feed.truth = read_truth(mrclam_folder() / (name + "_Groundtruth.dat"), start_s);
  return feed;
}

}  // namespace

std::filesystem::path mrclam_folder() { return std::filesystem::path(NADIR_REAL_DIR) / "mrclam6"; }

bool has_mrclam() { return std::filesystem::exists(mrclam_folder() / "Robot1_Odometry.dat"); }

MrclamFeed load_mrclam(int robot, const MrclamProtocol& protocol) {
  static std::map<int, MrclamFeed> recordings;  // the files are read once
  if (recordings.count(robot) == 0) recordings.emplace(robot, read_recording(robot));
  MrclamFeed feed = recordings.at(robot);
  feed.vision = vision_of(feed, protocol);
  return feed;
}

bool truth_at(const std::vector<TruthRow>& truth, double t_s, double max_gap_s, PlanarPose* pose) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), t_s,
                                      [](const TruthRow& row, double t) { return row.t_s < t; });
  if (after == truth.end() || after == truth.begin()) return false;
  const TruthRow& b = *after;
  const TruthRow& a = *(after - 1);
  if (b.t_s - a.t_s > max_gap_s) return false;
  const double part = (t_s - a.t_s) / (b.t_s - a.t_s);
  const Eigen::Vector3d way = pose_difference(b.pose, a.pose);
  *pose = {a.pose.x_m + part * way.x(), a.pose.y_m + part * way.y(),
           wrap_angle(a.pose.heading_rad + part * way.z())};
  return true;
}

void write_feed(const MrclamFeed& feed, const std::filesystem::path& folder) {
  std::ofstream odometry(folder / "odo.csv");
  odometry.precision(9);
  odometry << "t_s,u_mps,v_mps,r_radps\n";
  for (const OdometryRow& row : feed.odometry) {
    odometry << row.t_s << ',' << row.rates.u_mps << ',' << row.rates.v_mps << ','
             << row.rates.r_radps << '\n';
  }
  std::ofstream vision(folder / "vision.csv");
  vision.precision(12);
  vision << "t_capture_s,t_arrival_s,x_m,y_m,heading_rad,var_x_m2,var_y_m2,var_heading_rad2\n";
  for (const VisionRow& row : feed.vision) {
    vision << row.t_capture_s << ',' << row.t_arrival_s << ',' << row.pose.x_m << ','
           << row.pose.y_m << ',' << row.pose.heading_rad << ',' << row.var_x_m2 << ','
           << row.var_y_m2 << ',' << row.var_heading_rad2 << '\n';
  }
  std::ofstream truth(folder / "truth.csv");
  truth.precision(9);
  truth << "t_s,x_m,y_m,heading_rad\n";
  for (const TruthRow& row : feed.truth) {
    truth << row.t_s << ',' << row.pose.x_m << ',' << row.pose.y_m << ',' << row.pose.heading_rad
          << '\n';
  }
}

}  // namespace nadir::fusion
