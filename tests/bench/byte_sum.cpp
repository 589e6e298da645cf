#include "tests/bench/byte_sum.h"

#include <numeric>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nadir::bench {
namespace {

std::uint64_t sum_one_by_one(std::span<const std::uint8_t> bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
}

#if defined(__x86_64__)

constexpr std::size_t kBlockBytes = 64;  // of one stream in one round

std::uint64_t lanes_avx2(__m256i sums) __attribute__((target("avx2")));
std::uint64_t lanes_avx2(__m256i sums) {
  alignas(32) std::uint64_t lanes[4];
  _mm256_store_si256(reinterpret_cast<__m256i*>(lanes), sums);
  return lanes[0] + lanes[1] + lanes[2] + lanes[3];
}

/// Two streams of `blocks` blocks each.
__attribute__((target("avx2"))) std::uint64_t sum_avx2(const std::uint8_t* first,
                                                       const std::uint8_t* second, std::size_t step,
                                                       std::size_t blocks) {
  const __m256i zero = _mm256_setzero_si256();
  __m256i a = zero;
  __m256i b = zero;
  __m256i c = zero;
  __m256i d = zero;
  for (std::size_t i = 0; i < blocks; ++i, first += step, second += step) {
    const auto* p = reinterpret_cast<const __m256i*>(first);
    const auto* q = reinterpret_cast<const __m256i*>(second);
    a = _mm256_add_epi64(a, _mm256_sad_epu8(_mm256_loadu_si256(p), zero));
    b = _mm256_add_epi64(b, _mm256_sad_epu8(_mm256_loadu_si256(p + 1), zero));
    c = _mm256_add_epi64(c, _mm256_sad_epu8(_mm256_loadu_si256(q), zero));
    d = _mm256_add_epi64(d, _mm256_sad_epu8(_mm256_loadu_si256(q + 1), zero));
  }
  return lanes_avx2(_mm256_add_epi64(_mm256_add_epi64(a, b), _mm256_add_epi64(c, d)));
}

std::uint64_t sum_sse2(const std::uint8_t* first, const std::uint8_t* second, std::size_t step,
                       std::size_t blocks) {
  const __m128i zero = _mm_setzero_si128();
  __m128i a = zero;
  __m128i b = zero;
  for (std::size_t i = 0; i < blocks; ++i, first += step, second += step) {
    const auto* p = reinterpret_cast<const __m128i*>(first);
    const auto* q = reinterpret_cast<const __m128i*>(second);
    for (int quarter = 0; quarter < 4; ++quarter) {
      a = _mm_add_epi64(a, _mm_sad_epu8(_mm_loadu_si128(p + quarter), zero));
      b = _mm_add_epi64(b, _mm_sad_epu8(_mm_loadu_si128(q + quarter), zero));
    }
  }
  alignas(16) std::uint64_t lanes[2];
  _mm_store_si128(reinterpret_cast<__m128i*>(lanes), _mm_add_epi64(a, b));
  return lanes[0] + lanes[1];
}

std::uint64_t sum_blocks(const std::uint8_t* first, const std::uint8_t* second, std::size_t step,
                         std::size_t blocks) {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  return has_avx2 ? sum_avx2(first, second, step, blocks) : sum_sse2(first, second, step, blocks);
}

#endif

}  // namespace

#if defined(__x86_64__)

std::uint64_t byte_sum_in_order(std::span<const std::uint8_t> bytes) {
  const std::size_t blocks = bytes.size() / (2 * kBlockBytes);
  return sum_blocks(bytes.data(), bytes.data() + kBlockBytes, 2 * kBlockBytes, blocks) +
         sum_one_by_one(bytes.subspan(2 * kBlockBytes * blocks));
}

std::uint64_t byte_sum_two_streams(std::span<const std::uint8_t> bytes) {
  const std::size_t blocks = bytes.size() / (2 * kBlockBytes);
  const std::size_t half = blocks * kBlockBytes;
  return sum_blocks(bytes.data(), bytes.data() + half, kBlockBytes, blocks) +
         sum_one_by_one(bytes.subspan(2 * half));
}

#else

std::uint64_t byte_sum_in_order(std::span<const std::uint8_t> bytes) {
  return sum_one_by_one(bytes);
}

std::uint64_t byte_sum_two_streams(std::span<const std::uint8_t> bytes) {
  return sum_one_by_one(bytes);
}

#endif

}  // namespace nadir::bench
