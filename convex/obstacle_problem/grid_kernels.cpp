#include "convex/obstacle_problem/grid_kernels.hpp"

#include <algorithm>

#include "convex/double_double.hpp"
#include "convex/obstacle_problem/row_kernels.hpp"
#include "convex/processor.hpp"

namespace convex::inline obstacle_problem::grid_kernels {
namespace {

/// Independent sums along a row, added up in doubles.
constexpr Index lanes = 32;

double sum_of_lanes(const float* sums) {
  double sum = 0;
  for (Index l = 0; l < lanes; ++l) sum += static_cast<double>(sums[l]);
  return sum;
}

}  // namespace

MOREAU_CLONES
void relax(Index n, Index stride, float c, const float* inverse_d, const float* colour, const float* free,
           const float* r, float* u) {
  row_kernels::replace_row(n, u, [&](Index i) {
    const float around = (u[i - 1] + u[i + 1]) + (u[i - stride] + u[i + stride]);
    const float relaxed = free[i] * ((r[i] + c * around) * inverse_d[i]);
    return u[i] + colour[i] * (relaxed - u[i]);
  });
}

MOREAU_CLONES
void relax_zero(Index n, const float* inverse_d, const float* colour, const float* free, const float* r,
                float* __restrict u) {
  for (Index i = 0; i < n; ++i) u[i] = colour[i] * (free[i] * (r[i] * inverse_d[i]));
}

MOREAU_CLONES
void relax_above(Index n, Index stride, double c, double inverse_d, const double* colour, const double* lower,
                 const double* z, double* u) {
  row_kernels::replace_row(n, u, [&](Index i) {
    const double around = (u[i - 1] + u[i + 1]) + (u[i - stride] + u[i + stride]);
    const double relaxed = (z[i] + c * around) * inverse_d, held = relaxed > lower[i] ? relaxed : lower[i];
    return colour[i] > 0 ? held : u[i];
  });
}

MOREAU_CLONES
void add_residual(Index n, Index stride, const float* d, float c, const float* free, const float* r,
                  const float* u, float weight, const float* before, float* __restrict out) {
  for (Index i = 0; i < n; ++i) {
    const float around = (u[i - 1] + u[i + 1]) + (u[i - stride] + u[i + stride]);
    out[i] = before[i] + weight * (free[i] * (r[i] - (d[i] * u[i] - c * around)));
  }
}

MOREAU_CLONES
void gather(Index n, const float* fine, const float* free, float* __restrict coarse) {
  for (Index k = 0; k < n; ++k)
    coarse[k] = free[k] * (fine[2 * k + 1] + 0.5F * (fine[2 * k] + fine[2 * k + 2]));
}

MOREAU_CLONES
void spread(Index n, Index count, const float* m0, const float* m1, const float* free, float* __restrict mean,
            float* __restrict fine) {
  for (Index k = -1; k <= count; ++k) mean[k] = 0.5F * (m0[k] + m1[k]);
  const Index pairs = n / 2;
  for (Index k = 0; k < pairs; ++k) {
    fine[2 * k] += free[2 * k] * (0.5F * (mean[k - 1] + mean[k]));
    fine[2 * k + 1] += free[2 * k + 1] * mean[k];
  }
  if (n % 2 == 1) fine[n - 1] += free[n - 1] * (0.5F * (mean[pairs - 1] + mean[pairs]));
}

MOREAU_CLONES
double apply(Index n, Index stride, const float* d, float c, const float* free, const float* u,
             float* __restrict out) {
  float sums[lanes] = {};
  const auto at = [&](Index i) {
    const float around = (u[i - 1] + u[i + 1]) + (u[i - stride] + u[i + stride]);
    return free[i] * (d[i] * u[i] - c * around);
  };
  Index i = 0;
  for (; i + lanes <= n; i += lanes)
    for (Index l = 0; l < lanes; ++l) {
      const float value = at(i + l);
      out[i + l] = value;
      sums[l] += u[i + l] * value;
    }
  for (; i < n; ++i) {
    out[i] = at(i);
    sums[i % lanes] += u[i] * out[i];
  }
  return sum_of_lanes(sums);
}

MOREAU_CLONES
void residual(Index n, Index stride, double d, double c, const double* z, const double* u,
              double* __restrict out) {
  for (Index i = 0; i < n; ++i)
    out[i] = z[i] - (d * u[i] - c * ((u[i - 1] + u[i + 1]) + (u[i - stride] + u[i + stride])));
}

MOREAU_CLONES
void precise_residual(Index n, Index stride, double d, double c, const double* z_hi, const double* z_lo,
                      const double* u_hi, const double* u_lo, double* __restrict out) {
  const auto pair = [&](Index i) { return DoubleDouble{u_hi[i], u_lo[i]}; };
  for (Index i = 0; i < n; ++i) {
    const DoubleDouble around = add(add(pair(i - 1), pair(i + 1)), add(pair(i - stride), pair(i + stride)));
    DoubleDouble beside = two_product(c, around.hi), centre = two_product(-d, u_hi[i]);
    beside.lo += c * around.lo;
    centre.lo -= d * u_lo[i];
    out[i] = add({z_hi[i], z_lo[i]}, add(beside, centre)).value();
  }
}

MOREAU_CLONES
double energy(Index n, Index stride, double d, double c, const double* u) {
  constexpr Index lanes_of_doubles = lanes / 2;
  double sums[lanes_of_doubles] = {}, sum = 0;
  const double excess = d - 4 * c;
  const auto at = [&](Index i) {
    const double left = u[i] - u[i - 1], below = u[i] - u[i - stride];
    return excess * u[i] * u[i] + c * (left * left + below * below);
  };
  Index i = 0;
  for (; i + lanes_of_doubles <= n; i += lanes_of_doubles)
    for (Index l = 0; l < lanes_of_doubles; ++l) sums[l] += at(i + l);
  for (; i < n; ++i) sums[i % lanes_of_doubles] += at(i);
  for (double one : sums) sum += one;
  return sum;
}

MOREAU_CLONES
double choose(Index n, double d, const double* lower, const double* u, const double* rest,
              double* __restrict free) {
  double changed = 0;
  for (Index i = 0; i < n; ++i) {
    const double next = d * (lower[i] - u[i]) > rest[i] ? 0 : 1;
    changed += next != free[i] ? 1 : 0;
    free[i] = next;
  }
  return changed;
}

// Points that are not free are left out by products: where floats choose between doubles g++ 12 takes wrong
// ones for AVX-512.
MOREAU_CLONES
double free_square(Index n, const float* free, const double* r) {
  constexpr Index lanes_of_doubles = lanes / 2;
  double sums[lanes_of_doubles] = {}, sum = 0;
  const auto square = [&](Index i) {
    const double one = static_cast<double>(free[i]) * r[i];
    return one * one;
  };
  Index i = 0;
  for (; i + lanes_of_doubles <= n; i += lanes_of_doubles)
    for (Index l = 0; l < lanes_of_doubles; ++l) sums[l] += square(i + l);
  for (; i < n; ++i) sums[i % lanes_of_doubles] += square(i);
  for (double one : sums) sum += one;
  return sum;
}

MOREAU_CLONES
void take_free(Index n, const float* free, const double* r, double factor, float* __restrict out) {
  for (Index i = 0; i < n; ++i) out[i] = static_cast<float>(factor * (static_cast<double>(free[i]) * r[i]));
}

MOREAU_CLONES
void add_products(Index n, const float* r, const float* Ap, const float* z, Products& sums) {
  float of_r[lanes] = {}, of_Ap[lanes] = {};
  Index i = 0;
  for (; i + lanes <= n; i += lanes)
    for (Index l = 0; l < lanes; ++l) {
      of_r[l] += r[i + l] * z[i + l];
      of_Ap[l] += Ap[i + l] * z[i + l];
    }
  for (; i < n; ++i) {
    of_r[i % lanes] += r[i] * z[i];
    of_Ap[i % lanes] += Ap[i] * z[i];
  }
  sums.of_r += sum_of_lanes(of_r);
  sums.of_Ap += sum_of_lanes(of_Ap);
}

}  // namespace convex::inline obstacle_problem::grid_kernels
