// nadir-tracker as its users run it: another process, the bundled clip, files and a network.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tracker/wire/pose_reader.h"

namespace nadir::tracker {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using test::ChildProcess;
namespace fs = std::filesystem;

const fs::path kData = NADIR_DATA_DIR;
const fs::path kTracker = fs::path(NADIR_BIN_DIR) / "nadir-tracker";

std::string frame_name(int number) {
  std::string digits = std::to_string(number);
  return std::string(6 - digits.size(), '0') + digits + ".jpg";
}

// A folder with the first frames of the bundled clip.
class TrackerProgram : public testing::Test {
 protected:
  static constexpr int kFrames = 8;

  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "nadir_tracker_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    fs::create_directories(frames());
    for (int k = 0; k < kFrames; ++k) {
      fs::copy_file(kData / "clips/demo/frames" / frame_name(k), frames() / frame_name(k));
    }
    std::ifstream times(kData / "clips/demo/frames/times.csv");
    std::ofstream copy(frames() / "times.csv");
    std::string line;
    for (int k = 0; k <= kFrames && std::getline(times, line); ++k) copy << line << '\n';
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path frames() const { return folder_ / "frames"; }

  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"--source",      frames().string(),
                                    "--layout",      (kData / "layouts/league.yaml").string(),
                                    "--calibration", (kData / "calibrations/demo.yaml").string(),
                                    "--poses",       (folder_ / "poses.jsonl").string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::vector<json> poses() const {
    std::ifstream in(folder_ / "poses.jsonl");
    std::vector<json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
    return lines;
  }

  std::uintmax_t poses_size() const {
    std::error_code code;
    const std::uintmax_t size = fs::file_size(folder_ / "poses.jsonl", code);
    return code ? 0 : size;
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  // One line on stderr, exit code 2, nothing on stdout: what wrong input gets.
  void expect_refused(const std::vector<std::string>& words, const std::string& because) const {
    ChildProcess tracker(kTracker, words);
    EXPECT_EQ(tracker.wait(30s), 2) << tracker.err();
    EXPECT_EQ(tracker.out(), "");
    const std::string err = tracker.err();
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_NE(err.find(because), std::string::npos) << err;
  }

  fs::path folder_;
};

TEST_F(TrackerProgram, WritesTruePosesAndPicturesOfARecording) {
  ChildProcess tracker(kTracker,
                       arguments({"--no-publish", "--overlay", (folder_ / "pictures").string()}));
  ASSERT_EQ(tracker.wait(60s), 0) << tracker.err();
  EXPECT_EQ(tracker.out(), "");
  EXPECT_NE(tracker.err().find("8 frames, 0 skipped"), std::string::npos) << tracker.err();

  const std::vector<json> lines = poses();
  ASSERT_EQ(lines.size(), static_cast<std::size_t>(kFrames));
  std::ifstream truths(kData / "clips/demo/truth.jsonl");
  for (int k = 0; k < kFrames; ++k) {
    std::string line;
    ASSERT_TRUE(std::getline(truths, line));
    const json truth = json::parse(line);
    const json& seen = lines[static_cast<std::size_t>(k)];
    EXPECT_EQ(seen["frame"], k);
    EXPECT_EQ(seen["capture_ns"], truth["capture_ns"]);
    ASSERT_EQ(seen["robots"].size(), truth["robots"].size());
    for (const json& robot : truth["robots"]) {
      const auto match = std::ranges::find_if(seen["robots"], [&](const json& one) {
        return one["id"] == robot["id"] && one["team"] == robot["team"];
      });
      ASSERT_NE(match, seen["robots"].end()) << robot;
      EXPECT_LT(std::hypot((*match)["x_m"].get<double>() - robot["x_m"].get<double>(),
                           (*match)["y_m"].get<double>() - robot["y_m"].get<double>()),
                0.004);
    }
    EXPECT_TRUE(fs::exists(folder_ / "pictures" / ("00000" + std::to_string(k) + ".png")));
  }
}

TEST_F(TrackerProgram, PublishesWhatItWrites) {
  const test::LoopbackDds dds;
  ReaderOptions options;
  options.wire.domain = dds.domain();
  PoseReader reader(options);
  ChildProcess tracker(kTracker,
                       arguments({"--domain", std::to_string(dds.domain()), "--pace", "recorded"}),
                       dds.environment());
  // Frames may pass before reader and tracker have found each other; what arrives is compared.
  std::map<std::pair<std::uint64_t, int>, WirePose> received;
  WirePose pose;
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (std::chrono::steady_clock::now() < deadline) {
    if (reader.poll(&pose, 100ms)) {
      received[{pose.frame, pose.robot.robot}] = pose;
    } else if (tracker.wait(0ms)) {
      break;
    }
  }
  ASSERT_EQ(tracker.wait(30s), 0) << tracker.err();
  EXPECT_NE(tracker.err().find("published 48 poses and 8 frames"), std::string::npos)
      << tracker.err();
  ASSERT_FALSE(received.empty());
  const std::vector<json> lines = poses();
  for (const auto& [key, published] : received) {
    const json& frame = lines.at(key.first);
    const auto written = std::ranges::find_if(
        frame["robots"], [&key](const json& one) { return one["id"] == key.second; });
    ASSERT_NE(written, frame["robots"].end());
    EXPECT_EQ(published.robot.team, (*written)["team"]);
    EXPECT_EQ(published.capture_ns, frame["capture_ns"]);
    EXPECT_NEAR(published.robot.pose_world_robot.x_m, (*written)["x_m"].get<double>(), 1e-8);
    EXPECT_NEAR(published.robot.covariance(1, 1), (*written)["covariance"][4].get<double>(), 1e-12);
  }
}

TEST_F(TrackerProgram, SkipsAndCountsAnUnreadableImage) {
  std::ofstream(frames() / frame_name(3)) << "not a picture";
  ChildProcess tracker(kTracker, arguments({"--no-publish"}));
  ASSERT_EQ(tracker.wait(60s), 0) << tracker.err();
  EXPECT_NE(tracker.err().find(frame_name(3)), std::string::npos) << tracker.err();
  EXPECT_NE(tracker.err().find("7 frames, 1 skipped"), std::string::npos) << tracker.err();
  const std::vector<json> lines = poses();
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[3]["frame"], 4);
}

TEST_F(TrackerProgram, WritesLinesToStandardOutputAndNothingElse) {
  std::vector<std::string> words = arguments({"--no-publish"});
  *(std::ranges::find(words, "--poses") + 1) = "-";
  ChildProcess tracker(kTracker, words);
  ASSERT_EQ(tracker.wait(60s), 0) << tracker.err();
  std::istringstream out(tracker.out());
  int lines = 0;
  for (std::string line; std::getline(out, line); ++lines) EXPECT_TRUE(json::accept(line)) << line;
  EXPECT_EQ(lines, kFrames);
}

TEST_F(TrackerProgram, RefusesWrongInputInOneLine) {
  const std::string layout = (kData / "layouts/league.yaml").string();
  const std::string calibration = (kData / "calibrations/demo.yaml").string();
  const auto camera = [&](const std::string& source, const std::string& with_layout,
                          const std::string& with_cal) {
    return std::vector<std::string>{"--source",      source,   "--layout",    with_layout,
                                    "--calibration", with_cal, "--no-publish"};
  };
  const std::string clip = frames().string();
  expect_refused({}, "--source");
  expect_refused({"--nonsense"}, "--nonsense");
  expect_refused(camera("/nowhere", layout, calibration), "/nowhere");
  expect_refused(camera("teapot:3", layout, calibration), "teapot");
  expect_refused(camera(clip, "/nowhere.yaml", calibration), "/nowhere.yaml");
  expect_refused(camera(clip, layout, "/nowhere.yaml"), "/nowhere.yaml");
  const fs::path empty = folder_ / "empty";
  fs::create_directories(empty);
  expect_refused(camera(empty.string(), layout, calibration), "empty");
  std::vector<std::string> words = camera(clip, layout, calibration);
  words.insert(words.end(), {"--variance", "table"});
  expect_refused(words, "noise");
  expect_refused({"--config", write("t.yaml", "camera: []\n").string()}, "t.yaml:1:1");
  // The pair scene's camera has 640x480 pixels, the calibration is for 800x600.
  expect_refused(
      camera("synthetic:" + (kData / "scenes/pair_even.yaml").string(), layout, calibration),
      "640x480");
}

TEST_F(TrackerProgram, WarnsOfMarkersAtAnotherHeight) {
  const fs::path pair = kData / "layouts/pair.yaml";  // 0.12 m, the calibration is for 0.15 m
  ChildProcess tracker(kTracker, arguments({"--no-publish", "--layout", pair.string()}));
  // The league's and the pair's robots both have a blue team.
  EXPECT_EQ(tracker.wait(60s), 2) << tracker.err();
  EXPECT_NE(tracker.err().find("blue"), std::string::npos);
  std::vector<std::string> words = arguments({"--no-publish"});
  *(std::ranges::find(words, "--layout") + 1) = pair.string();
  ChildProcess alone(kTracker, words);
  EXPECT_EQ(alone.wait(60s), 0) << alone.err();
  EXPECT_NE(alone.err().find("warning: the markers of layout 'pair' are 0.12 m high"),
            std::string::npos)
      << alone.err();
}

class TrackerSignal : public TrackerProgram, public testing::WithParamInterface<int> {};

// A recording of more than a minute that is ended after its first frame.
TEST_P(TrackerSignal, EndsWithASummary) {
  std::ofstream times(frames() / "times.csv");
  times << "file,capture_ns\n";
  for (std::int64_t k = 0; k < kFrames; ++k) {
    times << frame_name(static_cast<int>(k)) << ',' << 1700000000000000000 + k * 10'000'000'000
          << '\n';
  }
  times.close();
  ChildProcess tracker(kTracker, arguments({"--no-publish", "--pace", "recorded"}));
  // The log is written while the tracker runs.
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (poses_size() == 0 && std::chrono::steady_clock::now() < deadline) usleep(2000);
  tracker.signal(GetParam());
  EXPECT_EQ(tracker.wait(30s), 0) << tracker.err();
  EXPECT_NE(tracker.err().find("cam0: 1 frames, 0 skipped"), std::string::npos) << tracker.err();
  EXPECT_EQ(poses().size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Clean, TrackerSignal, testing::Values(SIGINT, SIGTERM));

TEST_F(TrackerProgram, WaitsForACameraThatIsNotThereAndSaysSo) {
  std::vector<std::string> words = arguments({"--no-publish"});
  words[1] = "v4l2:/dev/video_that_is_not_there";
  ChildProcess tracker(kTracker, words);
  EXPECT_TRUE(tracker.wait_for_err("video_that_is_not_there", 30s));
  EXPECT_FALSE(tracker.wait(300ms).has_value());
  tracker.signal(SIGINT);
  EXPECT_EQ(tracker.wait(30s), 0) << tracker.err();
}

// Two cameras, one thread each, one file: all lines whole, all frames there.
TEST_F(TrackerProgram, TakesSeveralCameras) {
  const fs::path config = write(
      "two.yaml",
      "publish: false\nposes: poses.jsonl\ncameras:\n  - {name: a, source: frames, calibration: " +
          (kData / "calibrations/demo.yaml").string() + ", layouts: [" +
          (kData / "layouts/league.yaml").string() +
          "]}\n  - {name: b, source: frames, calibration: " +
          (kData / "calibrations/demo.yaml").string() + ", layouts: [" +
          (kData / "layouts/league.yaml").string() + "]}\n");
  ChildProcess tracker(kTracker, {"--config", config.string()});
  ASSERT_EQ(tracker.wait(60s), 0) << tracker.err();
  std::map<std::string, std::set<int>> seen;
  for (const json& line : poses()) seen[line["camera"]].insert(line["frame"].get<int>());
  EXPECT_EQ(seen["a"].size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(seen["b"].size(), static_cast<std::size_t>(kFrames));
}

}  // namespace
}  // namespace nadir::tracker
