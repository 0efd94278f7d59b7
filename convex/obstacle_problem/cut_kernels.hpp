#pragma once

#include <array>

#include "convex/vector.hpp"

namespace convex::inline obstacle_problem {

/// A row of a grid's equations, with a frame: pull_i u_i + Σ link (u_i - u_j).
template <class Number>
struct CutRow {
  Index n = 0;
  std::size_t dimension = 1;
  std::array<const Number*, 3> link{};  ///< to the next point along each axis used
  std::array<Index, 3> stride{};        ///< of the first axis 1
  const Number* pull = nullptr;
};

/// Work on one row, vectorised. Entry by entry results do not depend on the machine: no product is contracted
/// with a sum, and sums have a fixed order.
namespace cut_kernels {

/// u = (r + Σ link u_j) inverse on the points of a colour, where `colour` is 1, not 0; inverse: of the
/// diagonal, 0 where a point is not free.
void relax(const CutRow<float>&, const float* inverse, const float* colour, const float* r, float* u);
/// u = r inverse on the points of a colour, 0 on the others.
void relax_zero(Index n, const float* inverse, const float* colour, const float* r, float* u);
/// out = weight (r - A u).
void rest(const CutRow<float>&, const float* weight, const float* r, const float* u, float* out);
/// out = middle + half of the two beside.
void tent(Index n, const float* before, const float* middle, const float* after, float* out);
/// coarse_k = fine_2k + half of the two beside where inverse is not 0, else 0.
void gather(Index n, const float* fine, const float* inverse, float* coarse);
/// out = the mean of four rows.
void mean(Index n, const float* a, const float* b, const float* c, const float* d, float* out);
/// u += weight times coarse at its place, or the mean of the two beside; n: of the fine row.
void spread(Index n, const float* coarse, const float* weight, float* u);
/// out = (load - A q) scale where inverse is not 0, else 0.
void residual(const CutRow<double>&, const double* load, const float* inverse, double scale, const double* q,
              float* out);
/// q = max(lowest, (load + Σ link q_j) inverse) on the points of a colour that have an inverse.
void relax_above(const CutRow<double>&, const double* load, const double* inverse, const double* colour,
                 const double* lowest, double* q);

/// out = A u where inverse is not 0, else 0; the inner product of u with it.
double apply(const CutRow<float>&, const float* inverse, const float* u, float* out);
/// The inner products of r and of Ap with z.
struct Products {
  double of_r = 0, of_Ap = 0;
};
void add_products(Index n, const float* r, const float* Ap, const float* z, Products& sums);
/// q += scale x.
void add(Index n, double scale, const float* x, double* q);

}  // namespace cut_kernels
}  // namespace convex::inline obstacle_problem
