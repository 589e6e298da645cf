#include "tests/support/allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long> g_allocations{0};

void* counted(std::size_t size) {
  ++g_allocations;
  void* memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* counted(std::size_t size, std::align_val_t alignment) {
  ++g_allocations;
  const auto align = static_cast<std::size_t>(alignment);
  void* memory = std::aligned_alloc(align, (size + align - 1) / align * align);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, alignment);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
namespace {

TEST(NoAllocation, CounterCounts) {
  const long before = g_allocations;
  const std::vector<int> numbers(100);
  EXPECT_EQ(g_allocations - before, 1) << numbers.size();
}

TEST(NoAllocation, FromFrameToReportAndJsonAfterStartUp) {
  for (const char* scene : {"league_even", "pair_even"}) {
    SyntheticCamera camera = synthetic_camera(scene, 3);
    CameraPipeline pipeline(camera.setup, camera.renderer.camera().width_px(),
                            camera.renderer.camera().height_px());
    std::vector<vision::Frame> frames;
    for (std::uint64_t k = 0; k < 12; ++k) frames.push_back(rendered_frame(camera.renderer, k));
    FrameReport report;
    fmt::memory_buffer line;
    const auto work = [&](const vision::Frame& frame) {
      pipeline.process(frame, 0.0, report);
      line.clear();
      append_json(report, line);
    };
    for (const vision::Frame& frame : frames) work(frame);
    const long before = g_allocations;
    for (const vision::Frame& frame : frames) work(frame);
    EXPECT_EQ(g_allocations - before, 0) << scene;
  }
}

}  // namespace
}  // namespace nadir::tracker

long nadir::test::allocations() { return g_allocations; }
