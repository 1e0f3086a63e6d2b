#pragma once

/// Functions between BERNAL_BEGIN_TARGET(features) and BERNAL_END_TARGET are compiled for these instruction sets,
/// whatever the command line says; lambdas in them too. BERNAL_AVX512 is the set that the 512-bit loops need.
/// GCC and Clang have the same attribute, but other pragmas.
#define BERNAL_PRAGMA(...) _Pragma(#__VA_ARGS__)
#if defined(__clang__)
#define BERNAL_BEGIN_TARGET(features) \
  BERNAL_PRAGMA(clang attribute push(__attribute__((target(features))), apply_to = function))
#define BERNAL_END_TARGET BERNAL_PRAGMA(clang attribute pop)
#define BERNAL_AVX512 "avx512f,avx512dq,avx512vl,avx512bw"
/// The next loop carries nothing from one round to another.
#define BERNAL_INDEPENDENT_ROUNDS BERNAL_PRAGMA(clang loop vectorize(assume_safety))
#else
#define BERNAL_BEGIN_TARGET(features) BERNAL_PRAGMA(GCC push_options) BERNAL_PRAGMA(GCC target(features))
#define BERNAL_END_TARGET BERNAL_PRAGMA(GCC pop_options)
#define BERNAL_AVX512 "avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512"
#define BERNAL_INDEPENDENT_ROUNDS BERNAL_PRAGMA(GCC ivdep)
#endif
