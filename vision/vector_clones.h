#pragma once

/// Before a function with a hot loop: compiled twice, for processors with and without AVX2 and FMA;
/// which one runs is decided at start-up. Only where the compiler can do it (GCC on x86-64 from
/// version 12 on, without the address sanitizer); else nothing, as with NADIR_PLAIN, for
/// comparison.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__) && !defined(NADIR_PLAIN)
#define NADIR_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define NADIR_VECTOR_CLONES
#endif
