#pragma once

#include <cstring>

#include "convex/dense/compiled.hpp"

namespace convex::inline dense {

template <int W>
struct Register {
  using Doubles [[gnu::vector_size(W * sizeof(double))]] = double;
  using Wholes [[gnu::vector_size(W * sizeof(double))]] = long long;
};

/// The entries of x from `first` on, in a register of half the width.
template <class Half, int first, class Whole>
MOREAU_INLINE Half half_of(const Whole& x) {
#if __has_builtin(__builtin_shufflevector)
  if constexpr (sizeof(Half) == 4 * sizeof(double))
    return Half(__builtin_shufflevector(x, x, first, first + 1, first + 2, first + 3));
  else
    return Half(__builtin_shufflevector(x, x, first, first + 1));
#else  // g++ 11
  Half half;
  std::memcpy(&half, reinterpret_cast<const double*>(&x) + first, sizeof(Half));
  return half;
#endif
}

}  // namespace convex::inline dense
