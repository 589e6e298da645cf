// DRIVE.yaml: what it may say, and what is said of mistakes.

#include "control_client/drive/drive_config.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "control_client/robot_file.h"
#include "tests/vision/scratch_folder.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

std::string refusal_of(const std::string& text) {
  const vision::ScratchFolder folder;
  try {
    load_drive_config(folder.write("drive.yaml", text));
  } catch (const vision::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(DriveConfig, WhatIsPrintedReadsBackTheSame) {
  DriveConfig config;
  config.team = "yellow";
  config.robot = "/somewhere/omni4.yaml";
  config.output = tracker::WheelCommandKind::kRimSpeeds;
  config.clock_error = {-2.5, 30.0};
  config.place = {0.5, -0.25, 0.0};
  config.plan.nominal.kind = NominalKind::kFiltered;
  config.plan.repeats = true;
  config.fusion.model = OdometryModel::kWhite;
  config.safety.off_track_m = {0.2, 0.4};
  config.start.emplace(0.1, 0.2, 0.0);
  config.simulation.seed = 99;
  const std::string text = drive_config_yaml(config);
  const vision::ScratchFolder folder;
  const DriveConfig again = load_drive_config(folder.write("drive.yaml", text));
  EXPECT_EQ(drive_config_yaml(again), text);
  EXPECT_EQ(again.output, tracker::WheelCommandKind::kRimSpeeds);
  EXPECT_EQ(again.fusion.model, OdometryModel::kWhite);
  EXPECT_EQ(again.safety.off_track_m.stop, 0.4);
  EXPECT_EQ(again.start->y(), 0.2);
}

TEST(DriveConfig, NothingHasToBeSaid) {
  const vision::ScratchFolder folder;
  const DriveConfig config = load_drive_config(folder.write("drive.yaml", "team: blue\n"));
  EXPECT_EQ(drive_config_yaml(config), drive_config_yaml(DriveConfig{}));
  EXPECT_FALSE(config.start.has_value());
}

TEST(DriveConfig, TheBundledExampleNamesARobotBesideIt) {
  const DriveConfig config = load_drive_config(NADIR_DATA_DIR "/clients/league.yaml");
  EXPECT_EQ(load_robot(config.robot).robot.name, "omni3");
}

TEST(DriveConfig, SaysWhereAMistakeIs) {
  struct Mistake {
    const char* text;
    std::vector<std::string> words;
  };
  const std::vector<Mistake> mistakes = {
      {"temm: blue\n", {"drive.yaml:1", "temm", "team"}},
      {"output: torque\n", {"drive.yaml:1", "torque", "rim_speeds"}},
      {"safety:\n  pose_age_s: {slow: -1}\n", {"drive.yaml:2", "slow"}},
      {"safety:\n  pose_age: {slow: 1}\n", {"drive.yaml:2", "pose_age_s"}},
      {"domain: 500\n", {"drive.yaml:1", "domain", "101"}},
      {"team: a-name-that-is-far-too-long\n", {"team", "15"}},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string line = refusal_of(mistake.text);
    for (const std::string& word : mistake.words) {
      EXPECT_NE(line.find(word), std::string::npos) << mistake.text << " gave: " << line;
    }
  }
}

}  // namespace
}  // namespace nadir::control_client
