#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace nadir::test {

/// A DDS network of its own on the loopback interface: tests that run side by side do not see each
/// other. While it lives, CYCLONEDDS_URI of this process points to it; child processes get
/// environment().
class LoopbackDds {
 public:
  /// loss: share of packets that never leave this process or a child, 0 to 1.
  explicit LoopbackDds(double loss = 0.0);
  LoopbackDds(const LoopbackDds&) = delete;
  LoopbackDds& operator=(const LoopbackDds&) = delete;
  ~LoopbackDds();

  std::uint32_t domain() const { return domain_; }
  const std::string& uri() const { return uri_; }
  std::map<std::string, std::string> environment() const { return {{"CYCLONEDDS_URI", uri_}}; }

 private:
  std::uint32_t domain_ = 0;
  std::string uri_;
};

}  // namespace nadir::test
