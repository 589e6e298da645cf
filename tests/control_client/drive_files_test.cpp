// What a drive leaves behind: its log, the errors in it, the picture of it; and the live line.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "control_client/drive/client_watch.h"
#include "control_client/drive/drive_errors.h"
#include "control_client/drive/drive_figure.h"
#include "control_client/drive/drive_log.h"
#include "control_client/drive/drive_log_reader.h"
#include "tests/vision/scratch_folder.h"
#include "tracker/wire/clock_exchange.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

/// Half of it on the way, estimate 3 and 4 mm beside the truth, which is 1 mm left of the command.
DriveRecord record() {
  DriveRecord record{"blue3", {}};
  for (int i = 0; i < 200; ++i) {
    DriveRow row;
    row.time_s = 0.02 * i;
    row.drives = i < 190;
    row.slowed = (i >= 20 && i < 70) || i >= 190;
    row.follows = i >= 100;
    row.command = {0.001 * i, row.follows ? 0.0 : 5.0, 0.0};
    row.truth = {0.001 * i, 0.001, 0.0};
    row.estimate = {0.001 * i + 0.003, 0.001 + 0.004, 0.02};
    row.encoders = {0.002 * i, 0.001, M_PI};
    record.rows.push_back(row);
  }
  return record;
}

TEST(DriveErrors, AreRootMeanSquares) {
  const DriveErrors errors = measure_drive(record());
  EXPECT_NEAR(errors.fused.position_rms_m, 0.005, 1e-12);
  EXPECT_NEAR(errors.fused.position_max_m, 0.005, 1e-12);
  EXPECT_NEAR(errors.fused.heading_rms_rad, 0.02, 1e-12);
  EXPECT_NEAR(errors.encoders.position_max_m, 0.199, 1e-12);
  EXPECT_NEAR(errors.encoders.heading_rms_rad, M_PI, 1e-12);
  EXPECT_NEAR(errors.tracking.position_rms_m, 0.001, 1e-12) << "on the way does not count";
  EXPECT_NEAR(errors.duration_s, 3.98, 1e-12);
  EXPECT_NEAR(errors.slowed_s, 1.0, 1e-9) << "the last stop is the end of the drive";
  const auto json = error_json({errors});
  EXPECT_NEAR(json[0]["fused"]["position_rms_m"].get<double>(), 0.005, 1e-12);
  EXPECT_NE(error_table({errors}).find("5.00"), std::string::npos);
}

TEST(DriveFigure, ShowsEveryDriveWithItsErrors) {
  DriveRecord other = record();
  other.name = "blue5";
  const std::string svg = drive_figure({record(), other});
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  for (const char* text : {">blue3<", ">blue5<", ">encoders alone<", ">5.00<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(DriveLogReader, RefusesWhatIsNoLog) {
  const vision::ScratchFolder folder;
  const auto line_of = [&](const std::string& text) -> std::string {
    try {
      read_drive_log(folder.write("log.csv", text));
    } catch (const vision::InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(line_of("t_s,x_m\n1,2\n").find("mode"), std::string::npos);
  DriveLog(folder.path() / "empty.csv", true).finish();
  EXPECT_THROW(read_drive_log(folder.path() / "empty.csv"), vision::InputError);
  EXPECT_THROW(DriveLog(folder.path() / "no" / "where.csv", true), std::runtime_error);
}

tracker::WireClientState state(std::int64_t stamp_ns) {
  tracker::WireClientState state;
  state.team = "blue";
  state.robot = 3;
  state.mode = tracker::ClientMode::kDriving;
  state.stamp_ns = stamp_ns;
  state.clock_offset_ns = 5'000'000'000;
  state.clock_sigma_ns = 1000;
  state.pose_age_ns = 80'000'000;
  state.estimate_world_robot = {1.0, 0.0, 0.0};
  state.error_left_m = 0.002;
  return state;
}

TEST(ClientWatch, ComparesTheEstimateWithTheTruthOfItsMoment) {
  const std::int64_t now_ns = tracker::system_clock_ns();
  ClientWatch watch;
  watch.add(state(now_ns - 5'000'000'000));
  EXPECT_EQ(watch.line(now_ns), "blue 3 driving  2.0 mm off its path");
  tracker::WireSimulatedTruth truth;
  truth.team = "blue";
  truth.robot = 3;
  truth.time_ns = now_ns - 10'000'000;
  truth.pose_world_robot = {0.994, 0.0, 0.0};
  truth.velocity_x_mps = 0.5;
  watch.add(truth);
  EXPECT_EQ(watch.line(now_ns), "blue 3 driving  1.0 mm 0.00 deg");
  EXPECT_EQ(watch.line(now_ns + 10'000'000'000), "") << "it fell silent";
}

}  // namespace
}  // namespace nadir::control_client
