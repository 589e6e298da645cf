// nadir-client as a person uses it: what it prints, what it writes, and what it says of wrong
// input.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::control_client {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::string output_of(const std::vector<std::string>& arguments) {
  ChildProcess client(NADIR_CLIENT, arguments);
  EXPECT_EQ(client.wait(60s), 0) << client.err();
  return client.out();
}

/// Exit code 2, nothing on standard output, one line for a person with all of `words`.
void expect_refusal(const std::vector<std::string>& arguments,
                    const std::vector<std::string>& words) {
  ChildProcess client(NADIR_CLIENT, arguments);
  EXPECT_EQ(client.wait(60s), 2) << client.err();
  EXPECT_EQ(client.out(), "");
  const std::string line = client.err();
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  for (const std::string& word : words) {
    EXPECT_NE(line.find(word), std::string::npos) << "no '" << word << "' in: " << line;
  }
}

TEST(Client, ListsTrajectoriesAndExperimentsALineEach) {
  const std::string list = output_of({"list"});
  for (const char* line : {"trajectory  square-turning ", "trajectory  rose4 ", "experiment  e1 ",
                           "experiment  blackout ", "experiment  shaping "}) {
    EXPECT_NE(list.find(line), std::string::npos) << line << "in\n" << list;
  }
}

TEST(Client, ExperimentWritesFiguresAndAPicture) {
  const vision::ScratchFolder folder;
  const auto json_file = folder.path() / "e2.json";
  const auto svg_file = folder.path() / "e2.svg";
  const std::string table = output_of({"experiment", "e2", "--runs", "2", "--seed", "77", "--json",
                                       json_file.string(), "--plot", svg_file.string()});
  EXPECT_NE(table.find("e2: 2 runs, seeds from 77"), std::string::npos) << table;
  EXPECT_NE(table.find("encoders alone"), std::string::npos) << table;
  const auto json = nlohmann::json::parse(read_text(json_file));
  EXPECT_EQ(json["runs"], 2);
  EXPECT_EQ(json["first_seed"], 77);
  ASSERT_EQ(json["cases"].size(), 3U);
  EXPECT_EQ(json["cases"][0]["driver"], "fusion");
  EXPECT_LT(json["cases"][0]["to_nominal"]["position_rms_m"], 0.006);
  EXPECT_GT(json["cases"][1]["to_nominal"]["position_rms_m"], 0.006);
  const std::string svg = read_text(svg_file);
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find("driven by encoders alone"), std::string::npos);
}

TEST(Client, FollowsATrajectoryOfOnesOwn) {
  const vision::ScratchFolder folder;
  const auto file = folder.write(
      "tour.yaml", "waypoints:\n  - {x_m: 0, y_m: 0}\n  - {x_m: 0.5, y_m: 0.3, heading_rad: 1}\n");
  const std::string table =
      output_of({"experiment", "follow", "--runs", "1", "--trajectory", file.string(), "--robot",
                 NADIR_DATA_DIR "/robots/omni4.yaml"});
  EXPECT_NE(table.find("fusion"), std::string::npos) << table;
}

/// What `drive --print-config` prints with these arguments, and once more with what it printed, as
/// a file elsewhere.
std::string printed_config(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"drive", "--robot", "3", "--print-config"});
  const std::string text = output_of(arguments);
  const vision::ScratchFolder folder;
  const auto file = folder.write("printed.yaml", text);
  EXPECT_EQ(output_of({"drive", "--robot", "3", "--print-config", "--config", file.string()}),
            text);
  return text;
}

TEST(Client, PrintsWhatIsInForceSoThatItReadsBackAnywhere) {
  namespace fs = std::filesystem;
  const fs::path data = fs::relative(NADIR_DATA_DIR);
  ASSERT_TRUE(data.is_relative());
  const std::string omni4 =
      printed_config({"--robot-file", (data / "robots" / "omni4.yaml").string()});
  EXPECT_NE(omni4.find("omni4.yaml'\n"), std::string::npos) << omni4;
  EXPECT_NE(omni4.find("output: volts\n"), std::string::npos) << omni4;
  const std::string league =
      printed_config({"--config", (data / "clients" / "league.yaml").string()});
  EXPECT_NE(league.find("robot: '/"), std::string::npos) << league;
  // The file says 20 rad/s; slip_tolerance allows less.
  EXPECT_NE(league.find("tolerated_slip_s: 0.08\n"), std::string::npos) << league;
  EXPECT_NE(league.find("natural_frequency_radps: "), std::string::npos) << league;
  EXPECT_EQ(league.find("natural_frequency_radps: 20}"), std::string::npos) << league;
}

TEST(Client, PrintsTheOutputThatIsInForce) {
  for (const char* type : {"differential", "rover"}) {
    const std::string text = printed_config({"--robot-type", type});
    EXPECT_NE(text.find("output: body_rates\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("inner:"), std::string::npos) << text;
  }
}

TEST(Client, SaysInOneLineWhatIsWrong) {
  const vision::ScratchFolder folder;
  expect_refusal({"experiment", "e99"}, {"'e99'", "e1, e2"});
  expect_refusal({"experiment"}, {"name"});
  expect_refusal({}, {"subcommand"});
  expect_refusal({"experiment", "e1", "--runs", "0"}, {"--runs"});
  expect_refusal({"experiment", "follow", "--trajectory", "hexagon"}, {"'hexagon'", "rose3"});
  expect_refusal({"experiment", "follow", "--trajectory", "circle", "--speed", "8"},
                 {"circle", "times the robot's", "or slower"});
  const std::string header = "t_s,x_m,y_m,heading_rad\n0,0,0,0\n";
  const auto nan = folder.write("nan.csv", header + "1,nan,0,0\n");
  expect_refusal({"experiment", "follow", "--trajectory", nan.string()}, {"nan.csv:3:3", "nan"});
  const auto racing = folder.write("racing.csv", header + "1,9,0,0\n");
  expect_refusal({"experiment", "follow", "--trajectory", racing.string()},
                 {"racing.csv", "times the robot's", "or slower"});
  const auto robot = folder.write("two.yaml",
                                  "wheels:\n  - {angle_deg: 0, distance_m: 0.1}\n"
                                  "  - {angle_deg: 120, distance_m: 0.1}\n");
  expect_refusal({"experiment", "e1", "--robot", robot.string()}, {"two.yaml:1", "wheels"});
  expect_refusal({"experiment", "e1", "--robot", (folder.path() / "none.yaml").string()},
                 {"none.yaml"});
}

}  // namespace
}  // namespace nadir::control_client
