#include "control_client/robot_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::control_client {
namespace {

const std::filesystem::path kRobots = std::filesystem::path(NADIR_DATA_DIR) / "robots";

TEST(RobotFile, Omni3IsTheDefaultInCode) {
  const RobotConfig file = load_robot(kRobots / "omni3.yaml");
  const RobotModel from_file(file.robot);
  const RobotModel from_code{RobotParameters{}};
  EXPECT_LT((from_file.input() - from_code.input()).norm(), 1e-12);
  EXPECT_LT((from_file.damping_per_s() - from_code.damping_per_s()).norm(), 1e-12);
  EXPECT_LT((from_file.inertia_ratio() - from_code.inertia_ratio()).norm(), 1e-12);
  EXPECT_EQ(file.robot.motor.max_voltage_v, RobotParameters{}.motor.max_voltage_v);
  EXPECT_EQ(file.robot.max_turn_rate_radps, RobotParameters{}.max_turn_rate_radps);
  const ControlParameters control;
  EXPECT_EQ(file.control.inner_steps, control.inner_steps);
  EXPECT_EQ(file.control.tick_s, control.tick_s);
  EXPECT_EQ(file.control.inner.natural_frequency_radps, control.inner.natural_frequency_radps);
  EXPECT_EQ(file.control.outer.filter_bandwidth_radps, control.outer.filter_bandwidth_radps);
  EXPECT_EQ(file.control.tolerated_slip_s, control.tolerated_slip_s);
}

TEST(RobotFile, TableOfThePaperIsConsistent) {
  const ControlParameters control;
  EXPECT_DOUBLE_EQ(control.outer.integral_gain_per_s2(), 16.0);
  EXPECT_DOUBLE_EQ(control.outer.proportional_gain_per_s(), 7.2);
  EXPECT_DOUBLE_EQ(control.inner.integral_gain_per_s2(), 400.0);
  EXPECT_DOUBLE_EQ(control.inner.proportional_gain_per_s(), 36.0);
}

TEST(RobotFile, Omni4HasFourWheels) {
  EXPECT_EQ(RobotModel(load_robot(kRobots / "omni4.yaml").robot).wheel_count(), 4);
}

TEST(RobotFile, SaysInOneLineWhatIsWrong) {
  const vision::ScratchFolder folder;
  const auto complaint = [&](const std::string& text) {
    const auto file = folder.write("robot.yaml", text);
    return vision::input_error_line([&] { load_robot(file); });
  };
  const auto wheel = [](int angle_deg) {
    return "  - {angle_deg: " + std::to_string(angle_deg) + ", distance_m: 0.07}\n";
  };
  const std::string two = complaint("wheels:\n" + wheel(180) + wheel(60));
  EXPECT_NE(two.find("robot.yaml:1"), std::string::npos) << two;
  EXPECT_NE(two.find("wheels"), std::string::npos) << two;
  const std::string bundled = complaint("wheels:\n" + wheel(10) + wheel(10) + wheel(10));
  EXPECT_NE(bundled.find("robot.yaml:1"), std::string::npos) << bundled;
  EXPECT_NE(complaint("mass_kg: 2\n").find("wheels"), std::string::npos);
  const std::string three = "wheels:\n" + wheel(180) + wheel(-60) + wheel(60);
  EXPECT_NE(complaint(three + "mass_kg: -1\n").find("mass_kg"), std::string::npos);
  EXPECT_NE(complaint(three + "mas_kg: 1\n").find("mass_kg"), std::string::npos);
}

}  // namespace
}  // namespace nadir::control_client
