/* simd.h: vectors of 2, 4 and 8 doubles, and kernels that exist once per instruction set.
 *
 * v2, v4, v8 need no alignment. A kernel is an INLINE function; instances of it with the attributes
 * STF_AVX2 and STF_AVX512 are compiled for these, and stf_simd_width() tells which the processor has:
 * 8, 4 or, where nothing is known, 2.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SIMD_H
#define STF_SIMD_H

/* Doubles of a vector register of 256 bits; kernels of more lanes take twice as many, a line of cache. */
enum { STF_LANES = 4 };

#define INLINE static inline __attribute__((always_inline))
typedef double v2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef double v4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef double v8 __attribute__((vector_size(64), aligned(8), may_alias));

#if defined(__x86_64__)
#define STF_SIMD_X86
#define STF_AVX2 __attribute__((target("avx2,fma")))
#define STF_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,avx2,fma")))

static inline int stf_simd_width(void)
{
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma"))
    return 8;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? 4 : 2;
}
#else
static inline int stf_simd_width(void) { return 2; }
#endif

#endif
