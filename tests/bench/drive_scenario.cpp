#include "tests/bench/drive_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "control_client/drive/drive_log_reader.h"
#include "tests/bench/process_cost.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::bench {
namespace {

using test::ChildProcess;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

const std::filesystem::path kData = NADIR_DATA_DIR;

// Many robots share the field: each has a tour of 0.2 m.
constexpr const char* kTour =
    "waypoints:\n"
    "  - {x_m: -0.1, y_m: -0.05}\n"
    "  - {x_m: 0.1, y_m: -0.05, heading_rad: 1}\n"
    "  - {x_m: 0.1, y_m: 0.05}\n"
    "  - {x_m: -0.1, y_m: 0.05, heading_rad: -1}\n"
    "  - {x_m: -0.1, y_m: -0.05}\n";

/// The live scene, with a blackout so long after the tracker's start if one is asked for.
std::filesystem::path scene_with(const DriveScenario& scenario,
                                 const vision::ScratchFolder& folder) {
  const std::filesystem::path scene = kData / "scenes/live_league.yaml";
  if (scenario.blackout_s <= 0.0) return scene;
  std::ostringstream text;
  text << std::ifstream(scene).rdbuf();
  std::string yaml = text.str();
  const std::string layouts = "../layouts";
  yaml.replace(yaml.find(layouts), layouts.size(), (kData / "layouts").string());
  const std::string delivery = "delivery:";
  const std::size_t after = yaml.find('\n', yaml.find(delivery));
  yaml.insert(after, fmt::format("\n  blackouts: [{{start_s: {}, length_s: {}}}]",
                                 0.5 * scenario.duration_s, scenario.blackout_s));
  return folder.write("scene.yaml", yaml);
}

/// One run: the processes, and what is looked at while they work.
class Run {
 public:
  explicit Run(const DriveScenario& scenario)
      : scenario_(scenario),
        dds_(scenario.packet_loss),
        scene_(scene_with(scenario, folder_)),
        tour_(folder_.write("tour.yaml", kTour)) {}

  DriveResult finish() {
    start_tracker();
    for (int i = 0; i < scenario_.robots; ++i) start_client(i);
    const auto started = Clock::now();
    bool has_killed = false;
    double next_memory_s = 0.0;
    const double last_look_s = scenario_.duration_s - 1.0;
    for (double time_s = 0.0; time_s < last_look_s;
         time_s = Seconds(Clock::now() - started).count()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      if (scenario_.kills_tracker && !has_killed && time_s > 0.5 * scenario_.duration_s) {
        has_killed = true;
        tracker_->signal(SIGKILL);
        start_tracker();
      }
      if (scenario_.memory_every_s > 0.0 && time_s >= next_memory_s) {
        next_memory_s += scenario_.memory_every_s;
        result_.memory.push_back({time_s, process_memory_mb(tracker_->pid()),
                                  process_memory_mb(clients_.front()->pid())});
      }
    }
    measure_costs(Seconds(Clock::now() - started).count());
    for (std::size_t i = 0; i < clients_.size(); ++i) collect(i);
    result_.scenario = scenario_;
    return std::move(result_);
  }

 private:
  void start_tracker() {
    tracker_started_ = Clock::now();
    tracker_ = std::make_unique<ChildProcess>(
        std::filesystem::path(NADIR_BIN_DIR) / "nadir-tracker",
        std::vector<std::string>{"--source", "synthetic:" + scene_.string(), "--layout",
                                 (kData / "layouts/league.yaml").string(), "--calibration",
                                 (kData / "calibrations/live_league.yaml").string(), "--domain",
                                 std::to_string(dds_.domain())},
        dds_.environment());
  }

  // Sixteen blue robots, then yellow ones; on a grid, each on its own trajectory.
  void start_client(int i) {
    constexpr const char* kTrajectories[] = {"circle", "rose3", "square-turning"};
    constexpr int kNumbers = 16;
    const bool is_few = scenario_.robots <= 3;
    const std::string place =
        is_few ? fmt::format("{},{},0", -0.75 + 0.75 * i, i == 1 ? -0.35 : 0.35)
               : fmt::format("{},{},0", -1.05 + 0.3 * (i % 8), -0.66 + 0.44 * (i / 8));
    logs_.push_back(folder_.path() / fmt::format("{}.csv", kTrajectories[i % 3]));
    std::vector<std::string> arguments = {"drive",
                                          "--robot",
                                          std::to_string(i % kNumbers),
                                          "--team",
                                          i < kNumbers ? "blue" : "yellow",
                                          "--trajectory",
                                          is_few ? kTrajectories[i % 3] : tour_.string(),
                                          "--place=" + place,
                                          "--simulate",
                                          "--seed",
                                          std::to_string(i + 1),
                                          "--clock-error=" + std::to_string(1.5 - i),
                                          "--duration",
                                          fmt::format("{}", scenario_.duration_s),
                                          "--domain",
                                          std::to_string(dds_.domain())};
    if (!is_few) logs_.back() = folder_.path() / fmt::format("robot{}.csv", i);
    arguments.insert(arguments.end(), {"--log", logs_.back().string()});
    clients_.push_back(std::make_unique<ChildProcess>(
        std::filesystem::path(NADIR_BIN_DIR) / "nadir-client", arguments, dds_.environment()));
  }

  void measure_costs(double time_s) {
    result_.tracker = {
        process_cpu_s(tracker_->pid()) / Seconds(Clock::now() - tracker_started_).count(),
        process_memory_mb(tracker_->pid())};
    for (const auto& client : clients_) {
      const double share = 1.0 / static_cast<double>(clients_.size());
      result_.client.cpu_share += share * process_cpu_s(client->pid()) / time_s;
      result_.client.memory_mb += share * process_memory_mb(client->pid());
    }
  }

  void collect(std::size_t i) {
    const auto code = clients_[i]->wait(std::chrono::seconds(30));
    if (code != 0) throw std::runtime_error("a client failed: " + clients_[i]->err());
    result_.drives.push_back(
        control_client::measure_drive(control_client::read_drive_log(logs_[i])));
  }

  DriveScenario scenario_;
  test::LoopbackDds dds_;
  vision::ScratchFolder folder_;
  std::filesystem::path scene_;
  std::filesystem::path tour_;
  Clock::time_point tracker_started_;
  std::unique_ptr<ChildProcess> tracker_;
  std::vector<std::unique_ptr<ChildProcess>> clients_;
  std::vector<std::filesystem::path> logs_;
  DriveResult result_;
};

}  // namespace

double DriveResult::ticks_missed_share() const {
  double ticks = 0.0;
  double missed = 0.0;
  for (const control_client::DriveErrors& drive : drives) {
    ticks += drive.ticks + drive.ticks_missed;
    missed += drive.ticks_missed;
  }
  return ticks > 0.0 ? missed / ticks : 0.0;
}

control_client::DriveError DriveResult::fused() const {
  control_client::DriveError all;
  for (const control_client::DriveErrors& drive : drives) {
    all.position_rms_m = std::hypot(all.position_rms_m, drive.fused.position_rms_m);
    all.heading_rms_rad = std::hypot(all.heading_rms_rad, drive.fused.heading_rms_rad);
    all.position_max_m = std::max(all.position_max_m, drive.fused.position_max_m);
  }
  const double root = std::sqrt(std::max<double>(1.0, static_cast<double>(drives.size())));
  all.position_rms_m /= root;
  all.heading_rms_rad /= root;
  return all;
}

DriveResult run_drive(const DriveScenario& scenario) { return Run(scenario).finish(); }

}  // namespace nadir::bench
