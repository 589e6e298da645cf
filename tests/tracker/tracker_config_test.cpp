#include "tracker/tracker_config.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tracker/command_line.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

namespace fs = std::filesystem;

// A configuration file in a folder of its own.
class TrackerConfigFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("nadir_config_") + info->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text) const {
    std::ofstream(folder_ / "tracker.yaml") << text;
    return folder_ / "tracker.yaml";
  }

  // The message of the error that the text causes.
  std::string error_of(const std::string& text) const {
    try {
      load_tracker_config(write(text));
    } catch (const vision::InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

constexpr const char* kTwoCameras = R"(
domain: 7
cameras:
  - {name: north, source: clips/north, calibration: north.yaml, layouts: [league.yaml]}
  - {source: "v4l2:/dev/video3", calibration: /etc/south.yaml, layouts: [a.yaml, b.yaml], rate_hz: 90}
)";

TEST_F(TrackerConfigFile, ReadsCamerasAndResolvesPathsFromItsOwnFolder) {
  const TrackerConfig config = load_tracker_config(write(kTwoCameras));
  EXPECT_EQ(config.domain, 7);
  ASSERT_EQ(config.cameras.size(), 2u);
  EXPECT_EQ(config.cameras[0].name, "north");
  EXPECT_EQ(config.cameras[0].source, (folder_ / "clips/north").string());
  EXPECT_EQ(config.cameras[0].calibration, folder_ / "north.yaml");
  EXPECT_EQ(config.cameras[1].name, "cam1");
  EXPECT_EQ(config.cameras[1].source, "v4l2:/dev/video3");
  EXPECT_EQ(config.cameras[1].calibration, "/etc/south.yaml");
  EXPECT_EQ(config.cameras[1].layouts[1], folder_ / "b.yaml");
  EXPECT_EQ(config.cameras[1].rate_hz, 90.0);
}

TEST_F(TrackerConfigFile, PrintsWhatItReadsBack) {
  TrackerConfig config = load_tracker_config(write(kTwoCameras));
  config.partition = "it's";
  config.pace = Pace::kFastest;
  config.tracks.speed_limit_mps = 2.5;
  config.cameras[1].noise = "/etc/noise.yaml";
  config.cameras[1].variance = VarianceModel::kTable;
  const std::string printed = to_yaml(config);
  const TrackerConfig again = load_tracker_config(write(printed));
  EXPECT_EQ(to_yaml(again), printed);
  EXPECT_EQ(again.partition, "it's");
  EXPECT_EQ(again.cameras[1].variance, VarianceModel::kTable);
}

TEST_F(TrackerConfigFile, SaysWhatIsWrongAndWhere) {
  const std::string camera = "{source: a, calibration: b, layouts: [c]}";
  EXPECT_NE(error_of("domian: 3\ncameras: [" + camera + "]\n").find("tracker.yaml:1:1"),
            std::string::npos);
  EXPECT_NE(error_of("domian: 3\ncameras: [" + camera + "]\n").find("domain"), std::string::npos);
  EXPECT_NE(error_of("domain: 300\ncameras: [" + camera + "]\n"), "no error");
  EXPECT_NE(error_of("cameras: []\n"), "no error");
  EXPECT_NE(error_of("cameras: [{source: a, calibration: b, layouts: []}]\n").find("layout"),
            std::string::npos);
  EXPECT_NE(error_of("cameras: [" + camera + "]\npace: slow\n"), "no error");
  EXPECT_NE(error_of("cameras: [{name: a, source: a, calibration: b, layouts: [c]}, "
                     "{name: a, source: a, calibration: b, layouts: [c]}]\n")
                .find("two cameras"),
            std::string::npos);
  EXPECT_NE(error_of("cameras: [{source: a, calibration: b, layouts: [c], variance: table}]\n"),
            "no error");
  EXPECT_NE(error_of("cameras: [{source: a, calibration: b, layouts: [c], variance: pixels, "
                     "noise: d}]\n"),
            "no error");
  EXPECT_EQ(error_of("cameras: [{source: a, calibration: b, layouts: [c], variance: fisher, "
                     "noise: d}]\n"),
            "no error");
}

TEST(TrackerConfig, PaceFollowsPublishing) {
  TrackerConfig config;
  EXPECT_EQ(config.effective_pace(), Pace::kRecorded);
  config.publish = false;
  EXPECT_EQ(config.effective_pace(), Pace::kFastest);
  config.pace = Pace::kRecorded;
  EXPECT_EQ(config.effective_pace(), Pace::kRecorded);
}

TEST(TrackerConfig, BundledExamplesAreValid) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(NADIR_DATA_DIR) / "trackers")) {
    const TrackerConfig config = load_tracker_config(entry.path());
    ++files;
    for (const CameraConfig& camera : config.cameras) {
      EXPECT_TRUE(fs::exists(camera.calibration)) << camera.calibration;
      for (const fs::path& layout : camera.layouts) EXPECT_TRUE(fs::exists(layout)) << layout;
    }
  }
  EXPECT_GT(files, 0);
}

CommandLine parse(std::vector<std::string> words) {
  words.insert(words.begin(), "nadir-tracker");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return parse_command_line(static_cast<int>(pointers.size()), pointers.data());
}

TEST(TrackerCommandLine, DescribesOneCamera) {
  const CommandLine command =
      parse({"--source", "clip", "--layout", "a.yaml", "--layout", "b.yaml", "--calibration",
             "c.yaml", "--no-publish", "--poses", "-", "--variance", "law"});
  ASSERT_FALSE(command.exit_code.has_value());
  const TrackerConfig& config = command.config;
  ASSERT_EQ(config.cameras.size(), 1u);
  EXPECT_EQ(config.cameras[0].name, "cam0");
  EXPECT_EQ(config.cameras[0].layouts.size(), 2u);
  EXPECT_EQ(config.cameras[0].variance, VarianceModel::kLaw);
  EXPECT_FALSE(config.publish);
  EXPECT_EQ(config.poses, "-");
}

TEST_F(TrackerConfigFile, LosesAgainstTheCommandLine) {
  const std::string file = write(kTwoCameras).string();
  const TrackerConfig config = parse({"--config", file, "--domain", "9", "--camera", "north",
                                      "--source", "other", "--no-publish"})
                                   .config;
  EXPECT_EQ(config.domain, 9);
  EXPECT_FALSE(config.publish);
  EXPECT_EQ(config.cameras[0].source, "other");
  EXPECT_EQ(config.cameras[0].calibration, folder_ / "north.yaml");
  EXPECT_EQ(config.cameras[1].source, "v4l2:/dev/video3");
}

TEST_F(TrackerConfigFile, DemandsToKnowWhichCameraIsMeant) {
  const std::string file = write(kTwoCameras).string();
  EXPECT_THROW(parse({"--config", file, "--source", "other"}), vision::InputError);
  EXPECT_THROW(parse({"--config", file, "--camera", "west"}), vision::InputError);
}

TEST(TrackerCommandLine, DemandsSourceLayoutAndCalibration) {
  EXPECT_THROW(parse({}), vision::InputError);
  EXPECT_THROW(parse({"--source", "a"}), vision::InputError);
  EXPECT_THROW(parse({"--source", "a", "--layout", "b"}), vision::InputError);
}

TEST(TrackerCommandLine, WrongUsageIsExitCodeTwo) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(parse({"--pace", "slow"}).exit_code, 2);
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace nadir::tracker
