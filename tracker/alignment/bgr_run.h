#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "tracker/alignment/lanes.h"

/// Pixels of a colour image taken apart eight at a time, in the compiler's portable vectors.
namespace nadir::tracker::bgr_run {

inline constexpr int kRun = 8;  ///< pixels

// NOLINTBEGIN(modernize-use-using)
typedef std::uint8_t Bytes __attribute__((vector_size(16)));
typedef std::int32_t Words __attribute__((vector_size(4 * kRun)));
typedef float Values __attribute__((vector_size(4 * kRun)));
// NOLINTEND(modernize-use-using)

/// Reads pixels u to u + 7 of a row of `row_bytes` bytes: blue, green and red in the lower three
/// bytes of a word, whose highest byte is another's. Pixels beyond the row are arbitrary.
NADIR_INLINE void load(const std::uint8_t* row, int row_bytes, int u, Words& words) {
  constexpr int kBytesRead = 28;
  constexpr int kSecond = 12;
  const std::uint8_t* const bgr = row + 3 * static_cast<std::ptrdiff_t>(u);
  Bytes first, second;
  if (3 * u + kBytesRead <= row_bytes) {
    std::memcpy(&first, bgr, sizeof(Bytes));
    std::memcpy(&second, bgr + kSecond, sizeof(Bytes));
  } else {  // never reads past the row's end
    std::array<std::uint8_t, kBytesRead> tail{};
    std::memcpy(tail.data(), bgr, static_cast<std::size_t>(row_bytes - 3 * u));
    std::memcpy(&first, tail.data(), sizeof(Bytes));
    std::memcpy(&second, tail.data() + kSecond, sizeof(Bytes));
  }
  first = __builtin_shufflevector(first, first, 0, 1, 2, 3, 3, 4, 5, 6, 6, 7, 8, 9, 9, 10, 11, 12);
  second =
      __builtin_shufflevector(second, second, 0, 1, 2, 3, 3, 4, 5, 6, 6, 7, 8, 9, 9, 10, 11, 12);
  // Not by way of memory, where the two halves would have to be waited for.
  words = reinterpret_cast<Words>(
      __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15,
                              16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31));
}

/// One channel of the words, 0 blue, 1 green, 2 red.
NADIR_INLINE void channel(const Words& words, int index, Values& values) {
  values = __builtin_convertvector(words >> (8 * index) & 255, Values);
}

}  // namespace nadir::tracker::bgr_run
