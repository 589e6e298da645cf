#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nadir::bench {

// Merely reading every byte of a frame once: the yardstick of the search. AVX2 where the processor
// has it (as in the detector), else SSE2; four sums at once, so that memory is what it waits for.

/// Sum of all bytes, read from the first to the last.
std::uint64_t byte_sum_in_order(std::span<const std::uint8_t> bytes);

/// The same sum, read in two halves side by side: two streams keep the memory busier.
std::uint64_t byte_sum_two_streams(std::span<const std::uint8_t> bytes);

}  // namespace nadir::bench
