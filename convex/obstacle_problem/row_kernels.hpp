#pragma once

#include "convex/vector.hpp"

namespace convex::inline obstacle_problem {

/// What rows of every grid have in common. Results do not depend on the machine: no product is contracted
/// with a sum.
namespace row_kernels {

/// x += step p, r -= step Ap.
void advance(Index n, float step, const float* p, const float* Ap, float* x, float* r);
/// p = z + part p.
void turn(Index n, float part, const float* z, float* p);

/// u_i = next(i) along a row. Points beside each other have other colours, so that next(i) is the same before
/// and after they change; a block is written when the next one has been read, for reading across what was
/// just written is slow.
template <class Number, class Next>
[[gnu::always_inline]] inline void replace_row(Index n, Number* u, Next next) {
  constexpr Index block = 32;
  Number before[block], now[block];
  Index i = 0;
  for (; i + block <= n; i += block) {
    for (Index l = 0; l < block; ++l) now[l] = next(i + l);
    for (Index l = 0; l < block && i > 0; ++l) u[i - block + l] = before[l];
    for (Index l = 0; l < block; ++l) before[l] = now[l];
  }
  for (Index l = 0; l < n - i; ++l) now[l] = next(i + l);
  for (Index l = 0; l < block && i > 0; ++l) u[i - block + l] = before[l];
  for (Index l = 0; l < n - i; ++l) u[i + l] = now[l];
}

}  // namespace row_kernels

/// For cycles whose rows nobody waits for.
struct Unheard {
  void operator()(Index) const {}
};

}  // namespace convex::inline obstacle_problem
