#include "tests/system/drive_loop.h"

namespace nadir::system_test {

using test::ChildProcess;

ChildProcess DriveLoop::tracker() const {
  const std::filesystem::path data = NADIR_DATA_DIR;
  return {std::filesystem::path(NADIR_BIN_DIR) / "nadir-tracker",
          {"--source", "synthetic:" + (data / "scenes/live_league.yaml").string(), "--layout",
           (data / "layouts/league.yaml").string(), "--calibration",
           (data / "calibrations/live_league.yaml").string(), "--domain",
           std::to_string(dds_.domain())},
          dds_.environment()};
}

ChildProcess DriveLoop::client(const std::string& verb, std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), {verb, "--domain", std::to_string(dds_.domain())});
  return {std::filesystem::path(NADIR_BIN_DIR) / "nadir-client", arguments, dds_.environment()};
}

ChildProcess DriveLoop::drive(const std::string& trajectory, double duration_s,
                              const std::vector<std::string>& more) const {
  std::vector<std::string> arguments = {"--robot",      "3",          "--trajectory",
                                        trajectory,     "--simulate", "--log",
                                        log().string(), "--duration", std::to_string(duration_s)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return client("drive", arguments);
}

}  // namespace nadir::system_test
