#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "control_client/drive/drive_log_reader.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::system_test {

/// A network of its own with nadir-tracker before the live scene and nadir-client driving in it.
class DriveLoop {
 public:
  explicit DriveLoop(double packet_loss = 0.0) : dds_(packet_loss) {}

  test::ChildProcess tracker() const;
  /// `nadir-client VERB ARGUMENTS` on this network.
  test::ChildProcess client(const std::string& verb, std::vector<std::string> arguments) const;
  /// The simulated robot blue 3, logged.
  test::ChildProcess drive(const std::string& trajectory, double duration_s,
                           const std::vector<std::string>& more = {}) const;

  std::filesystem::path log() const { return folder_.path() / "drive.csv"; }
  control_client::DriveRecord record() const { return control_client::read_drive_log(log()); }
  const test::LoopbackDds& dds() const { return dds_; }
  const vision::ScratchFolder& folder() const { return folder_; }

 private:
  test::LoopbackDds dds_;
  vision::ScratchFolder folder_;
};

}  // namespace nadir::system_test
