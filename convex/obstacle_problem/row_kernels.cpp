#include "convex/obstacle_problem/row_kernels.hpp"

#include "convex/processor.hpp"

namespace convex::inline obstacle_problem::row_kernels {

MOREAU_CLONES
void advance(Index n, float step, const float* p, const float* Ap, float* __restrict x, float* __restrict r) {
  for (Index i = 0; i < n; ++i) {
    x[i] += step * p[i];
    r[i] -= step * Ap[i];
  }
}

MOREAU_CLONES
void turn(Index n, float part, const float* z, float* __restrict p) {
  for (Index i = 0; i < n; ++i) p[i] = z[i] + part * p[i];
}

}  // namespace convex::inline obstacle_problem::row_kernels
