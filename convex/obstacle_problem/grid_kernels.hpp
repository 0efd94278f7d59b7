#pragma once

#include "convex/vector.hpp"

namespace convex::inline obstacle_problem {

/// Work on one row of a grid, vectorised; neighbours beside, above and below are read at i ± 1 and
/// i ± stride. Results do not depend on the machine: no product is contracted with a sum, and sums have a
/// fixed order.
namespace grid_kernels {

/// u = free (r + c Σ neighbours of u)/d on the points of a colour (`colour` is 1 there, else 0).
void relax(Index n, Index stride, float c, const float* inverse_d, const float* colour, const float* free,
           const float* r, float* u);
/// u = free r/d on the points of a colour, 0 on the others.
void relax_zero(Index n, const float* inverse_d, const float* colour, const float* free, const float* r,
                float* u);
/// u = max(lower, (z + c Σ neighbours of u)/d) on the points of a colour.
void relax_above(Index n, Index stride, double c, double inverse_d, const double* colour, const double* lower,
                 const double* z, double* u);
/// out = weight (free (r - A u)) + before.
void add_residual(Index n, Index stride, const float* d, float c, const float* free, const float* r,
                  const float* u, float weight, const float* before, float* out);
/// coarse_k = free_k (fine_(2k+1) + half of the two beside).
void gather(Index n, const float* fine, const float* free, float* coarse);
/// fine += free P coarse, coarse: the mean of the rows m0 and m1; n: of the fine row, count: of the coarse
/// one.
void spread(Index n, Index count, const float* m0, const float* m1, const float* free, float* mean,
            float* fine);

/// out = free (d u - c Σ neighbours); the inner product of u with it.
double apply(Index n, Index stride, const float* d, float c, const float* free, const float* u, float* out);
/// out = z - (d u - c Σ neighbours).
void residual(Index n, Index stride, double d, double c, const double* z, const double* u, double* out);
/// The same with z and u as pairs, in twice the working precision, rounded at the end.
void precise_residual(Index n, Index stride, double d, double c, const double* z_hi, const double* z_lo,
                      const double* u_hi, const double* u_lo, double* out);
/// (d - 4c) Σ u² + c Σ (difference to the one on the left)² + c Σ (to the one below)², over n points.
double energy(Index n, Index stride, double d, double c, const double* u);

/// free = 1 where rest >= d (lower - u), else 0; how many changed.
double choose(Index n, double d, const double* lower, const double* u, const double* rest, double* free);
/// The sum of squares of r, finite, where free is 1, not 0.
double free_square(Index n, const float* free, const double* r);
/// out = factor r where free is 1, else 0.
void take_free(Index n, const float* free, const double* r, double factor, float* out);

/// The inner products of r and of Ap with z, sums of products.
struct Products {
  double of_r = 0, of_Ap = 0;
};
void add_products(Index n, const float* r, const float* Ap, const float* z, Products& sums);

}  // namespace grid_kernels
}  // namespace convex::inline obstacle_problem
