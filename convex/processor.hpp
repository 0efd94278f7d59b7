#pragma once

#include <cstddef>

/// Loops so marked are compiled for several generations of x86-64 and the best is chosen when the program
/// starts, so that one binary runs anywhere at the machine's speed. Features are named, not processors: a
/// named processor would match no newer one. Entry by entry the results are the same bit by bit, for products
/// and sums are not contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define MOREAU_CLONES [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define MOREAU_CLONES
#endif

/// Where code by hand is compiled for these families too, and may be chosen by `processor`.
#if defined(__x86_64__) && defined(__GNUC__)
#define MOREAU_HAS_FAMILIES 1
#endif

namespace convex {

/// Families of processors, each able to run what those before it can.
enum class Processor : std::size_t {
  any,
  avx2,   ///< four doubles at a time, and fused products
  avx512  ///< eight
};

/// That of this machine.
inline Processor processor() {
#ifdef MOREAU_HAS_FAMILIES
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return Processor::any;
  return __builtin_cpu_supports("avx512f") ? Processor::avx512 : Processor::avx2;
#else
  return Processor::any;
#endif
}

}  // namespace convex
