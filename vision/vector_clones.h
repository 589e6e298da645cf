#pragma once

/// Before a function with a hot loop: compiled twice, for processors with and without AVX2; which
/// one runs is decided at start-up. Only where the compiler can do it (GCC on x86-64, without the
/// address sanitizer); else nothing.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define NADIR_VECTOR_CLONES __attribute__((target_clones("avx2,fma", "default")))
#else
#define NADIR_VECTOR_CLONES
#endif
