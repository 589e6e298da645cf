// What nadir-client drive says of wrong input: one line, exit code 2, before anything moves.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::system_test {
namespace {

using namespace std::chrono_literals;

void expect_refusal(std::vector<std::string> arguments, const std::vector<std::string>& words) {
  arguments.insert(arguments.begin(), "drive");
  test::ChildProcess client(std::filesystem::path(NADIR_BIN_DIR) / "nadir-client", arguments);
  EXPECT_EQ(client.wait(60s), 2) << client.err();
  EXPECT_EQ(client.out(), "");
  const std::string line = client.err();
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  for (const std::string& word : words) {
    EXPECT_NE(line.find(word), std::string::npos) << "no '" << word << "' in: " << line;
  }
}

TEST(DriveWrongInput, OfTheCommandLine) {
  expect_refusal({}, {"--robot"});
  expect_refusal({"--robot", "3"}, {"--trajectory"});
  expect_refusal({"--robot", "3", "--trajectory", "hexagon"}, {"'hexagon'", "circle", "rose4"});
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--domain", "200"}, {"--domain"});
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--team", ""}, {"team"});
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--place", "1,2"}, {"--place"});
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--start", "0,0,0"}, {"--simulate"});
}

TEST(DriveWrongInput, OfTrajectories) {
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--speed", "9"},
                 {"circle", "times the robot's", "or slower"});
  const vision::ScratchFolder folder;
  const std::string header = "t_s,x_m,y_m,heading_rad\n0,0,0,0\n";
  const auto nan = folder.write("nan.csv", header + "1,nan,0,0\n");
  expect_refusal({"--robot", "3", "--trajectory", nan.string()}, {"nan.csv:3:3", "nan"});
  const auto backwards = folder.write("back.csv", header + "1,0.1,0,0\n0.5,0.1,0,0\n");
  expect_refusal({"--robot", "3", "--trajectory", backwards.string()}, {"back.csv:4", "rise"});
  const auto single = folder.write("single.yaml", "waypoints:\n  - {x_m: 0, y_m: 0}\n");
  expect_refusal({"--robot", "3", "--trajectory", single.string()}, {"single.yaml", "two"});
}

TEST(DriveWrongInput, OfRobots) {
  const vision::ScratchFolder folder;
  const auto two = folder.write("two.yaml",
                                "wheels:\n  - {angle_deg: 0, distance_m: 0.1}\n"
                                "  - {angle_deg: 120, distance_m: 0.1}\n");
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--robot-file", two.string()},
                 {"two.yaml:1", "wheels"});
  const auto singular = folder.write("singular.yaml",
                                     "wheels:\n  - {angle_deg: 0, distance_m: 0.1}\n"
                                     "  - {angle_deg: 180, distance_m: 0.1}\n"
                                     "  - {angle_deg: 0, distance_m: 0.2}\n");
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--robot-file", singular.string()},
                 {"singular.yaml:1", "wheels"});
}

TEST(DriveWrongInput, OfTypesOfRobots) {
  const std::vector<std::string> drive = {"--robot", "3", "--trajectory"};
  const auto refused = [&](const std::vector<std::string>& more,
                           const std::vector<std::string>& words) {
    std::vector<std::string> all = drive;
    all.insert(all.end(), more.begin(), more.end());
    expect_refusal(all, words);
  };
  refused({"circle", "--robot-type", "hovercraft"},
          {"'hovercraft'", "omnidirectional", "differential"});
  refused({"circle", "--robot-type", "differential"}, {"circle", "sideways", "two-circles"});
  refused({"two-circles", "--robot-type", "differential", "--speed", "5"},
          {"two-circles", "times the robot's speed limit", "or slower"});
  const vision::ScratchFolder folder;
  const auto two = folder.write("two.yaml", "type: differential\ntrack: 0.2\n");
  refused({"two-circles", "--robot-file", two.string()}, {"two.yaml:2", "track_m"});
  refused({"circle", "--robot-file", two.string(), "--robot-type", "omnidirectional"},
          {"two.yaml", "differential", "not omnidirectional"});
}

TEST(DriveWrongInput, OfTheConfiguration) {
  const vision::ScratchFolder folder;
  const auto typo = folder.write("typo.yaml", "team: blue\nsafty: {release: 0.5}\n");
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--config", typo.string()},
                 {"typo.yaml:2", "safty", "safety"});
  const auto robot = folder.write("robot.yaml", "robot: nowhere.yaml\n");
  expect_refusal({"--robot", "3", "--trajectory", "circle", "--config", robot.string()},
                 {"nowhere.yaml"});
}

}  // namespace
}  // namespace nadir::system_test
