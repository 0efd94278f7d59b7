#pragma once

#include "convex/processor.hpp"

// Packs never cross a function that is not inlined, so how they would be passed does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Inlined into kernels that are compiled for a processor family each.
#define MOREAU_INLINE [[gnu::always_inline]] static inline
#define MOREAU_INLINE_MEMBER [[gnu::always_inline]] inline

namespace convex::inline dense {

/// `at` is f, compiled for the family of processors with registers of W doubles; `apart` too, once for all
/// that call it, where f is long and compiling it into each of them would take most of the time of a build.
template <int W, auto f>
struct Compiled;
#define MOREAU_COMPILED(W, target)                                      \
  template <class R, class... X, R (*f)(X...)>                          \
  struct Compiled<W, f> {                                               \
    target static R at(X... x) { return f(x...); }                      \
    target [[gnu::noinline]] static R apart(X... x) { return f(x...); } \
  };
MOREAU_COMPILED(2, )
#ifdef MOREAU_HAS_FAMILIES
MOREAU_COMPILED(4, [[gnu::target("avx2,fma")]])
MOREAU_COMPILED(8, [[gnu::target("avx512f")]])
#endif

}  // namespace convex::inline dense
