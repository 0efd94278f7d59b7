#include "convex/obstacle_problem/cut_kernels.hpp"

#include "convex/obstacle_problem/row_kernels.hpp"
#include "convex/processor.hpp"

namespace convex::inline obstacle_problem::cut_kernels {
namespace {

/// Independent sums along a row, in doubles: squares of small floats are none.
constexpr Index lanes = 16;

double sum_of_lanes(const double* sums) {
  double sum = 0;
  for (Index l = 0; l < lanes; ++l) sum += sums[l];
  return sum;
}

template <std::size_t dimension, class Number>
[[gnu::always_inline]] inline Number around(const CutRow<Number>& row, const Number* u, Index i) {
  const Number* x = row.link[0];
  Number sum = x[i] * u[i + 1] + x[i - 1] * u[i - 1];
  for (std::size_t axis = 1; axis < dimension; ++axis) {
    const Number* y = row.link[axis];
    const Index s = row.stride[axis];
    sum += y[i] * u[i + s] + y[i - s] * u[i - s];
  }
  return sum;
}

/// (A u)_i from differences: what u and its neighbours have in common is not rounded.
template <std::size_t dimension, class Number>
[[gnu::always_inline]] inline Number applied(const CutRow<Number>& row, const Number* u, Index i) {
  const Number* x = row.link[0];
  Number sum = row.pull[i] * u[i] + (x[i] * (u[i] - u[i + 1]) + x[i - 1] * (u[i] - u[i - 1]));
  for (std::size_t axis = 1; axis < dimension; ++axis) {
    const Number* y = row.link[axis];
    const Index s = row.stride[axis];
    sum += y[i] * (u[i] - u[i + s]) + y[i - s] * (u[i] - u[i - s]);
  }
  return sum;
}

template <std::size_t dimension>
[[gnu::always_inline]] inline void relax_in(const CutRow<float>& given, const float* inverse,
                                            const float* colour, const float* r, float* u) {
  const CutRow<float> row = given;
  row_kernels::replace_row(
      row.n, u, [&](Index i) __attribute__((always_inline)) {
        const float relaxed = inverse[i] * (r[i] + around<dimension>(row, u, i));
        return u[i] + colour[i] * (relaxed - u[i]);
      });
}

template <std::size_t dimension>
[[gnu::always_inline]] inline void relax_above_in(const CutRow<double>& given, const double* load,
                                                  const double* inverse, const double* colour,
                                                  const double* lowest, double* q) {
  const CutRow<double> row = given;
  row_kernels::replace_row(
      row.n, q, [&](Index i) __attribute__((always_inline)) {
        const double relaxed = inverse[i] * (load[i] + around<dimension>(row, q, i));
        const double held = relaxed > lowest[i] ? relaxed : lowest[i];
        return colour[i] * inverse[i] > 0 ? held : q[i];
      });
}

template <std::size_t dimension>
[[gnu::always_inline]] inline void rest_in(const CutRow<float>& given, const float* weight, const float* r,
                                           const float* u, float* __restrict out) {
  const CutRow<float> row = given;
  for (Index i = 0; i < row.n; ++i) out[i] = weight[i] * (r[i] - applied<dimension>(row, u, i));
}

template <std::size_t dimension>
[[gnu::always_inline]] inline void residual_in(const CutRow<double>& given, const double* load,
                                               const float* inverse, double scale, const double* q,
                                               float* __restrict out) {
  const CutRow<double> row = given;
  for (Index i = 0; i < row.n; ++i) {
    const double here = scale * (load[i] - applied<dimension>(row, q, i));
    out[i] = inverse[i] > 0 ? static_cast<float>(here) : 0.0F;
  }
}

template <std::size_t dimension>
[[gnu::always_inline]] inline double apply_in(const CutRow<float>& given, const float* inverse,
                                              const float* u, float* __restrict out) {
  const CutRow<float> row = given;
  const auto value = [&](Index i) {
    const float here = applied<dimension>(row, u, i);
    return inverse[i] > 0 ? here : 0.0F;
  };
  double sums[lanes] = {};
  Index i = 0;
  for (; i + lanes <= row.n; i += lanes)
    for (Index l = 0; l < lanes; ++l) {
      const float here = value(i + l);
      out[i + l] = here;
      sums[l] += static_cast<double>(u[i + l]) * static_cast<double>(here);
    }
  for (; i < row.n; ++i) {
    out[i] = value(i);
    sums[i % lanes] += static_cast<double>(u[i]) * static_cast<double>(out[i]);
  }
  return sum_of_lanes(sums);
}

}  // namespace

MOREAU_CLONES
void relax(const CutRow<float>& row, const float* inverse, const float* colour, const float* r, float* u) {
  if (row.dimension == 2) return relax_in<2>(row, inverse, colour, r, u);
  if (row.dimension == 3) return relax_in<3>(row, inverse, colour, r, u);
  relax_in<1>(row, inverse, colour, r, u);
}

MOREAU_CLONES
void relax_zero(Index n, const float* inverse, const float* colour, const float* r, float* __restrict u) {
  for (Index i = 0; i < n; ++i) u[i] = colour[i] * (inverse[i] * r[i]);
}

MOREAU_CLONES
void rest(const CutRow<float>& row, const float* weight, const float* r, const float* u, float* out) {
  if (row.dimension == 2) return rest_in<2>(row, weight, r, u, out);
  if (row.dimension == 3) return rest_in<3>(row, weight, r, u, out);
  rest_in<1>(row, weight, r, u, out);
}

MOREAU_CLONES
void tent(Index n, const float* before, const float* middle, const float* after, float* __restrict out) {
  for (Index i = 0; i < n; ++i) out[i] = middle[i] + 0.5F * (before[i] + after[i]);
}

MOREAU_CLONES
void gather(Index n, const float* fine, const float* inverse, float* __restrict coarse) {
  for (Index k = 0; k < n; ++k) {
    const float sum = fine[2 * k] + 0.5F * (fine[2 * k - 1] + fine[2 * k + 1]);
    coarse[k] = inverse[k] > 0 ? sum : 0.0F;
  }
}

MOREAU_CLONES
void mean(Index n, const float* a, const float* b, const float* c, const float* d, float* __restrict out) {
  for (Index i = 0; i < n; ++i) out[i] = 0.25F * ((a[i] + b[i]) + (c[i] + d[i]));
}

MOREAU_CLONES
void spread(Index n, const float* coarse, const float* weight, float* __restrict u) {
  const Index pairs = n / 2;
  for (Index k = 0; k < pairs; ++k) {
    u[2 * k] += weight[2 * k] * coarse[k];
    u[2 * k + 1] += weight[2 * k + 1] * (0.5F * (coarse[k] + coarse[k + 1]));
  }
  if (n % 2 == 1) u[n - 1] += weight[n - 1] * coarse[pairs];
}

MOREAU_CLONES
void residual(const CutRow<double>& row, const double* load, const float* inverse, double scale,
              const double* q, float* out) {
  if (row.dimension == 2) return residual_in<2>(row, load, inverse, scale, q, out);
  if (row.dimension == 3) return residual_in<3>(row, load, inverse, scale, q, out);
  residual_in<1>(row, load, inverse, scale, q, out);
}

MOREAU_CLONES
void relax_above(const CutRow<double>& row, const double* load, const double* inverse, const double* colour,
                 const double* lowest, double* q) {
  if (row.dimension == 2) return relax_above_in<2>(row, load, inverse, colour, lowest, q);
  if (row.dimension == 3) return relax_above_in<3>(row, load, inverse, colour, lowest, q);
  relax_above_in<1>(row, load, inverse, colour, lowest, q);
}

MOREAU_CLONES
double apply(const CutRow<float>& row, const float* inverse, const float* u, float* out) {
  if (row.dimension == 2) return apply_in<2>(row, inverse, u, out);
  if (row.dimension == 3) return apply_in<3>(row, inverse, u, out);
  return apply_in<1>(row, inverse, u, out);
}

MOREAU_CLONES
void add_products(Index n, const float* r, const float* Ap, const float* z, Products& sums) {
  double of_r[lanes] = {}, of_Ap[lanes] = {};
  const auto add = [&](Index i, Index l) {
    const double here = static_cast<double>(z[i]);
    of_r[l] += static_cast<double>(r[i]) * here;
    of_Ap[l] += static_cast<double>(Ap[i]) * here;
  };
  Index i = 0;
  for (; i + lanes <= n; i += lanes)
    for (Index l = 0; l < lanes; ++l) add(i + l, l);
  for (; i < n; ++i) add(i, i % lanes);
  sums.of_r += sum_of_lanes(of_r);
  sums.of_Ap += sum_of_lanes(of_Ap);
}

MOREAU_CLONES
void add(Index n, double scale, const float* x, double* __restrict q) {
  for (Index i = 0; i < n; ++i) q[i] += scale * static_cast<double>(x[i]);
}

}  // namespace convex::inline obstacle_problem::cut_kernels
