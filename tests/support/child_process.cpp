#include "tests/support/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <thread>

extern char** environ;

namespace nadir::test {
namespace {

constexpr const char* kOut = "stdout";
constexpr const char* kErr = "stderr";
constexpr std::chrono::milliseconds kLookAgain{5};

std::filesystem::path make_temporary_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "nadir-child-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot create " + pattern);
  return pattern;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The test's own environment with the additions on top, as "NAME=value".
std::vector<std::string> merged(const ChildProcess::Environment& additions) {
  std::vector<std::string> lines;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view line(*entry);
    if (!additions.contains(std::string(line.substr(0, line.find('='))))) lines.emplace_back(line);
  }
  for (const auto& [name, value] : additions) {
    lines.push_back(name);
    lines.back().append("=").append(value);
  }
  return lines;
}

std::vector<char*> pointers(std::vector<std::string>* lines) {
  std::vector<char*> list;
  for (std::string& line : *lines) list.push_back(line.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           const Environment& environment)
    : folder_(make_temporary_folder()) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, (folder_ / kOut).c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&files, 2, (folder_ / kErr).c_str(), kFlags, 0600);
  std::vector<std::string> command = {program.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = merged(environment);
  const int error = posix_spawnp(&pid_, program.c_str(), &files, nullptr, pointers(&command).data(),
                                 pointers(&variables).data());
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    std::filesystem::remove_all(folder_);
    throw std::runtime_error("cannot start " + program.string() + ": " + std::strerror(error));
  }
}

ChildProcess::~ChildProcess() {
  signal(SIGKILL);
  wait(std::chrono::seconds(10));
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::optional<int> ChildProcess::wait(std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (!exit_code_) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (std::chrono::steady_clock::now() >= end) {
      break;
    } else {
      std::this_thread::sleep_for(kLookAgain);
    }
  }
  return exit_code_;
}

void ChildProcess::signal(int number) {
  if (!exit_code_ && pid_ > 0) kill(pid_, number);
}

std::string ChildProcess::out() const { return read_text(folder_ / kOut); }
std::string ChildProcess::err() const { return read_text(folder_ / kErr); }

bool ChildProcess::wait_for_out(const std::string& text, std::chrono::milliseconds timeout) {
  return wait_for(kOut, text, timeout);
}

bool ChildProcess::wait_for_err(const std::string& text, std::chrono::milliseconds timeout) {
  return wait_for(kErr, text, timeout);
}

bool ChildProcess::wait_for(const char* file, const std::string& text,
                            std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (true) {
    const bool ended = wait(std::chrono::milliseconds(0)).has_value();
    if (read_text(folder_ / file).find(text) != std::string::npos) return true;
    if (ended || std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kLookAgain);
  }
}

}  // namespace nadir::test
