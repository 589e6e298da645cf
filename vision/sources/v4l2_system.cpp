#include "vision/sources/v4l2_system.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <thread>

namespace nadir::vision {
namespace {

std::chrono::nanoseconds read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

class KernelV4l2 final : public V4l2System {
 public:
  int open_device(const std::string& path) override {
    const int descriptor = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return descriptor < 0 ? -errno : descriptor;
  }

  void close_device(int descriptor) override { close(descriptor); }

  int control(int descriptor, std::uint32_t request, void* argument) override {
    while (ioctl(descriptor, request, argument) < 0) {
      if (errno != EINTR) return -errno;
    }
    return 0;
  }

  const std::uint8_t* map(int descriptor, std::size_t length, std::int64_t offset) override {
    // Drivers refuse a mapping that is not also writable.
    void* const memory =
        mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, offset);
    return memory == MAP_FAILED ? nullptr : static_cast<const std::uint8_t*>(memory);
  }

  void unmap(const std::uint8_t* memory, std::size_t length) override {
    munmap(const_cast<std::uint8_t*>(memory), length);
  }

  int wait_readable(int descriptor, std::chrono::milliseconds timeout) override {
    pollfd wanted{descriptor, POLLIN, 0};
    const int ready = poll(&wanted, 1, static_cast<int>(timeout.count()));
    if (ready < 0) return errno == EINTR ? 0 : -errno;
    if (ready == 0) return 0;
    return (wanted.revents & POLLIN) != 0 ? 1 : -ENODEV;
  }

  std::chrono::nanoseconds monotonic_now() override { return read_clock(CLOCK_MONOTONIC); }
  std::chrono::nanoseconds unix_now() override { return read_clock(CLOCK_REALTIME); }
  void sleep(std::chrono::nanoseconds duration) override { std::this_thread::sleep_for(duration); }
};

}  // namespace

V4l2System& kernel_v4l2() {
  static KernelV4l2 kernel;
  return kernel;
}

}  // namespace nadir::vision
