// What a person gets who gives nadir-tracker or nadir-calibrate something wrong: one line that
// names the place and says what to do, and exit code 2.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::system_test {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
namespace fs = std::filesystem;

const fs::path kBin = NADIR_BIN_DIR;
const fs::path kData = NADIR_DATA_DIR;
const fs::path kClip = kData / "clips/demo";
const fs::path kLeague = kData / "layouts/league.yaml";

std::string read_text(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The text with the first `part` replaced; fails the test if it is not there.
std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t place = text.find(part);
  EXPECT_NE(place, std::string::npos) << "no '" << part << "' in the text";
  if (place != std::string::npos) text.replace(place, part.size(), by);
  return text;
}

/// Exit code 2, nothing for other programs to read, and one line for a person that has all of
/// `words`.
void expect_one_line(ChildProcess& process, const std::vector<std::string>& words) {
  EXPECT_EQ(process.wait(30s), 2) << process.err();
  EXPECT_EQ(process.out(), "");
  const std::string line = process.err();
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  for (const std::string& word : words) {
    EXPECT_NE(line.find(word), std::string::npos) << "no '" << word << "' in: " << line;
  }
}

class WrongInput : public testing::Test {
 protected:
  WrongInput() {
    ChildProcess fit(kBin / "nadir-calibrate",
                     {"field", kClip / "points.csv", "--height", "0.15", "-o", calibration_});
    EXPECT_EQ(fit.wait(30s), 0) << fit.err();
  }

  std::vector<std::string> tracker_arguments(const std::string& source, const fs::path& layout,
                                             const fs::path& calibration) const {
    return {"--source",  source,         "--layout", layout, "--calibration",
            calibration, "--no-publish", "--poses",  poses_};
  }

  /// A folder with the first `count` pictures of the bundled clip.
  fs::path pictures(int count) const {
    const fs::path folder = scratch_.path() / "frames";
    fs::create_directory(folder);
    for (int i = 0; i < count; ++i) {
      const std::string name = "00000" + std::to_string(i) + ".jpg";
      fs::copy_file(kClip / "frames" / name, folder / name);
    }
    return folder;
  }

  void expect_tracker_refuses(const std::string& source, const fs::path& layout,
                              const fs::path& calibration, const std::vector<std::string>& words) {
    ChildProcess tracker(kBin / "nadir-tracker", tracker_arguments(source, layout, calibration));
    expect_one_line(tracker, words);
  }

  vision::ScratchFolder scratch_;
  fs::path calibration_ = scratch_.path() / "calibration.yaml";
  fs::path poses_ = scratch_.path() / "poses.jsonl";
};

TEST_F(WrongInput, TheRightInputOfTheseTestsIsTaken) {
  ChildProcess tracker(kBin / "nadir-tracker",
                       tracker_arguments(pictures(2), kLeague, calibration_));
  EXPECT_EQ(tracker.wait(60s), 0) << tracker.err();
  const std::string lines = read_text(poses_);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 2);
}

TEST_F(WrongInput, MissingFilesAreNamed) {
  const fs::path absent = scratch_.path() / "absent";
  expect_tracker_refuses(absent, kLeague, calibration_, {absent});
  expect_tracker_refuses(kClip / "frames", absent, calibration_, {absent});
  expect_tracker_refuses(kClip / "frames", kLeague, absent, {absent});
}

TEST_F(WrongInput, MissingPointsAreNamed) {
  const fs::path absent = scratch_.path() / "absent.csv";
  ChildProcess fit(kBin / "nadir-calibrate",
                   {"field", absent, "--height", "0.15", "-o", scratch_.path() / "new.yaml"});
  expect_one_line(fit, {absent});
  EXPECT_FALSE(fs::exists(scratch_.path() / "new.yaml"));
}

TEST_F(WrongInput, PointsThatAreNoNumbersAreNamedWithLineAndColumn) {
  const fs::path points = scratch_.write(
      "points.csv", "u_px,v_px,x_m,y_m\n0,0,0,0\n1,0,one,0\n0,1,0,1\n1,1,1,1\n2,1,2,1\n1,2,1,2\n");
  ChildProcess fit(kBin / "nadir-calibrate",
                   {"field", points, "--height", "0.15", "-o", scratch_.path() / "new.yaml"});
  expect_one_line(fit, {points.string() + ":3:5", "one"});
}

TEST_F(WrongInput, UnreadablePictureIsReportedSkippedAndCounted) {
  const fs::path folder = pictures(4);
  std::ofstream(folder / "000001.jpg", std::ios::trunc) << "not a picture";
  ChildProcess tracker(kBin / "nadir-tracker", tracker_arguments(folder, kLeague, calibration_));
  EXPECT_EQ(tracker.wait(60s), 0) << tracker.err();
  EXPECT_NE(tracker.err().find("000001.jpg"), std::string::npos) << tracker.err();
  EXPECT_NE(tracker.err().find("1 skipped"), std::string::npos) << tracker.err();
  const std::string lines = read_text(poses_);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 3);
}

TEST_F(WrongInput, PictureOfAnotherSizeThanTheCalibrationIsRefused) {
  // The points of the calibration reach beyond the picture's border.
  const fs::path points = scratch_.write("large.csv", [] {
    std::string text = "u_px,v_px,x_m,y_m\n";
    for (int v = 0; v <= 2000; v += 500) {
      for (int u = 0; u <= 2500; u += 500) {
        text += std::to_string(u) + "," + std::to_string(v) + "," + std::to_string(u * 0.005) +
                "," + std::to_string(v * -0.005) + "\n";
      }
    }
    return text;
  }());
  const fs::path large = scratch_.path() / "large.yaml";
  ChildProcess fit(kBin / "nadir-calibrate", {"field", points, "--height", "0.15", "-o", large});
  ASSERT_EQ(fit.wait(30s), 0) << fit.err();
  expect_tracker_refuses(kClip / "frames", kLeague, large, {"800x600"});
}

TEST_F(WrongInput, UnknownKeyOfALayoutIsNamedWithTheNearestOne) {
  const fs::path layout =
      scratch_.write("layout.yaml", replaced(read_text(kLeague), "height_m:", "heigth_m:"));
  expect_tracker_refuses(kClip / "frames", layout, calibration_,
                         {layout.string() + ":", "height_m"});
}

TEST_F(WrongInput, DuplicateKeyOfALayoutIsNamed) {
  const fs::path layout = scratch_.write("layout.yaml", read_text(kLeague) + "\nheight_m: 0.12\n");
  expect_tracker_refuses(kClip / "frames", layout, calibration_,
                         {layout.string() + ":", "height_m", "already on line 5"});
}

TEST_F(WrongInput, LayoutWithTwoEqualIdentitiesIsRefused) {
  const fs::path layout = scratch_.write("layout.yaml", R"(name: twins
kind: discs
height_m: 0.15
teams: {blue: blue}
centre_radius_m: 0.025
outer:
  - {x_m:  0.06, y_m: 0.03, radius_m: 0.02}
  - {x_m: -0.06, y_m: 0.00, radius_m: 0.02}
identities: {0: [pink, green], 1: [green, pink], 2: [pink, green]}
)");
  expect_tracker_refuses(kClip / "frames", layout, calibration_, {layout.string() + ":9", "2"});
}

TEST_F(WrongInput, CalibrationOfAnotherVersionIsRefused) {
  const fs::path other = scratch_.write(
      "other.yaml",
      replaced(read_text(calibration_), "nadir_calibration: 2", "nadir_calibration: 99"));
  expect_tracker_refuses(kClip / "frames", kLeague, other, {other.string() + ":", "99"});
  ChildProcess validate(kBin / "nadir-calibrate", {"validate", other, kClip / "points.csv"});
  expect_one_line(validate, {other.string() + ":", "99"});
}

TEST_F(WrongInput, EmptyFolderIsRefused) {
  const fs::path folder = pictures(0);
  expect_tracker_refuses(folder, kLeague, calibration_, {folder});
}

TEST_F(WrongInput, UnknownSourceSchemeIsNamedWithThePossibleOnes) {
  expect_tracker_refuses("ftp:frames", kLeague, calibration_, {"'ftp'", "v4l2:", "synthetic:"});
}

TEST_F(WrongInput, CameraThatIsNotThereIsWaitedForAndSaysSo) {
  ChildProcess tracker(kBin / "nadir-tracker",
                       tracker_arguments("v4l2:/dev/video-absent", kLeague, calibration_));
  EXPECT_TRUE(tracker.wait_for_err("/dev/video-absent", 30s)) << tracker.err();
  EXPECT_NE(tracker.err().find("trying"), std::string::npos) << tracker.err();
  EXPECT_EQ(tracker.wait(300ms), std::nullopt) << "gave up: " << tracker.err();
  tracker.signal(SIGINT);
  EXPECT_EQ(tracker.wait(30s), 0) << tracker.err();
}

}  // namespace
}  // namespace nadir::system_test
