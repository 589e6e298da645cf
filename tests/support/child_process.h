#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nadir::test {

/// Another process for a test: started by the constructor, killed and reaped by the destructor.
/// What it prints goes to files in a temporary folder of its own, so it never blocks and can be
/// read at any time.
///
///     ChildProcess listen(bin("nadir-listen"), {"--json"}, dds.environment());
///     ASSERT_EQ(listen.wait(10s), 0) << listen.err();
class ChildProcess {
 public:
  using Environment = std::map<std::string, std::string>;

  /// program: a path, or a name to be found in PATH. environment: added to that of the test.
  /// Throws std::runtime_error if it cannot be started.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const Environment& environment = {});
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  /// Exit code, or 128 + signal; nothing if it still runs after the time-out.
  std::optional<int> wait(std::chrono::milliseconds timeout);
  /// Sends a signal, e.g. SIGINT, if it still runs.
  void signal(int number);
  pid_t pid() const { return pid_; }

  /// All of stdout, stderr so far.
  std::string out() const;
  std::string err() const;
  /// Waits until the text stands in stdout, stderr. False after the time-out, or if it ended
  /// without.
  bool wait_for_out(const std::string& text, std::chrono::milliseconds timeout);
  bool wait_for_err(const std::string& text, std::chrono::milliseconds timeout);

 private:
  bool wait_for(const char* file, const std::string& text, std::chrono::milliseconds timeout);

  std::filesystem::path folder_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace nadir::test
