#include "convex/nearest_point/isotonic/chain_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/dense/compiled.hpp"
#include "convex/double_double.hpp"
#include "convex/processor.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline isotonic::chain_kernels {

MOREAU_CLONES
Index count_links(Index count, const double* values, Index& ones) {
  Index fit = 0, units = 0;
  for (Index a = 0; a < count; ++a) {
    const double c = values[2 * a + 1];
    fit += (c > 0 ? 1 : 0) & (values[2 * a] == -c ? 1 : 0);
    units += c == 1 ? 1 : 0;
  }
  ones += units;
  return fit;
}

MOREAU_CLONES
void make_tidy(Index count, double* hi, double* lo) {
#pragma GCC ivdep
  for (Index k = 0; k < count; ++k) {
    const DoubleDouble sum = two_sum(hi[k], lo[k]);
    hi[k] = sum.hi;
    lo[k] = sum.lo;
  }
}

MOREAU_CLONES
void lift(Block& block, const double* offset_hi, const double* offset_lo) {
  double *const x_hi = block.x_hi.data() + 1, *const x_lo = block.x_lo.data() + 1;
#pragma GCC ivdep
  for (Index j = 0; j < block.count; ++j) {
    const DoubleDouble x = add({x_hi[j], x_lo[j]}, {offset_hi[j], offset_lo[j]});
    x_hi[j] = x.hi;
    x_lo[j] = x.lo;
  }
}

MOREAU_CLONES
void lower(Index count, const double* mass, const double* linear, const double* offset_hi,
           const double* offset_lo, double* hi, double* lo) {
#pragma GCC ivdep
  for (Index j = 0; j < count; ++j) {
    const DoubleDouble load = add({linear[j], 0}, negative(product({offset_hi[j], offset_lo[j]}, mass[j])));
    hi[j] = load.hi;
    lo[j] = load.lo;
  }
}

MOREAU_CLONES
void weigh(Block& block) {
  const double *const masses = block.mass, *const linear_terms = block.linear;
#pragma GCC ivdep
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double mass = masses[j], lo = block.x_lo[j + 1];
    const DoubleDouble plain = two_product(mass, block.x_hi[j + 1]),
                       inertia = two_sum(plain.hi, plain.lo + lo * mass),
                       left = two_sum(linear_terms[j], -inertia.hi);
    block.plain_hi[j] = plain.hi;
    block.plain_lo[j] = plain.lo;
    block.inertia[j] = std::abs(inertia.hi);
    block.left_hi[j] = left.hi;
    block.left_lo[j] = left.lo - inertia.lo;
  }
}

MOREAU_CLONES
Index drop_rounding(Block& block) {
  Index pulls = 0;
#pragma GCC ivdep
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double pushed = block.pushed[j], quiet = zero_of_long_sums * block.largest[j];
    pulls += pushed < -quiet ? 1 : 0;
    block.pushed[j] = pushed > quiet ? pushed : 0;
  }
  return pulls;
}

MOREAU_CLONES
void divide(Block& block) {
#pragma GCC ivdep
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double lambda = block.pushed[j] / block.factor[j];
    const DoubleDouble load = two_product(lambda, block.factor[j]);
    block.lambda[j] = lambda;
    block.load_hi[j + 1] = load.hi;
    block.load_lo[j + 1] = load.lo;
  }
}

void copy(Block& block) {
  for (std::size_t j = 0; j < at(block.count); ++j) {
    block.lambda[j] = block.load_hi[j + 1] = block.pushed[j];
    block.load_lo[j + 1] = 0;
  }
}

namespace {

/// The sum of n terms, in lanes that are kept apart.
MOREAU_INLINE void add_by_lanes(Index count, const Numbers& term, std::array<double, lanes>& sum) {
  Index j = 0;
  for (; j + lanes <= count; j += lanes)
    for (Index lane = 0; lane < lanes; ++lane) sum[at(lane)] += term[at(j + lane)];
  for (std::size_t lane = 0; j < count; ++j, ++lane) sum[lane] += term[at(j)];
}

}  // namespace

MOREAU_CLONES
void judge(Block& block, Squares& squares) {
  Numbers unbalanced, q, z, lost;
  const double *const masses = block.mass, *const linear_terms = block.linear;
#pragma GCC ivdep
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double mass = masses[j], linear = linear_terms[j], x = block.x_hi[j + 1], lo = block.x_lo[j + 1];
    const DoubleDouble below = two_sum(linear, block.load_hi[j]),
                       above = two_sum(below.hi, -block.load_hi[j + 1]),
                       inertia = two_sum(above.hi, -block.plain_hi[j]);
    const double small = (below.lo + block.load_lo[j]) + (above.lo - block.load_lo[j + 1]),
                 rest = inertia.hi + (small + (inertia.lo - block.plain_lo[j])), inverse = 1 / mass;
    unbalanced[j] = rest * rest * inverse;
    q[j] = x * x * mass;
    z[j] = linear * linear * inverse;
    lost[j] = lo * lo * mass;
  }
  add_by_lanes(block.count, unbalanced, squares.unbalanced);
  add_by_lanes(block.count, q, squares.q);
  add_by_lanes(block.count, z, squares.z);
  add_by_lanes(block.count, lost, squares.lost);
}

namespace {

/// The largest of n numbers, and of `least`.
MOREAU_INLINE double largest_of(Index count, const Numbers& x, double least) {
  std::array<double, 2 * lanes> most;
  most.fill(least);
  Index j = 0;
  for (; j + 2 * lanes <= count; j += 2 * lanes)
    for (std::size_t lane = 0; lane < 2 * lanes; ++lane) {
      const double y = x[at(j) + lane];
      most[lane] = y > most[lane] ? y : most[lane];
    }
  for (; j < count; ++j) most[0] = std::max(most[0], x[at(j)]);
  return *std::max_element(most.begin(), most.end());
}

}  // namespace

MOREAU_CLONES
void measure_links(Index count, const double* mass, const double* q, const double* s, const double* lambda,
                   double largest, Links& links) {
  const double part = 1 / std::max(largest, std::numeric_limits<double>::min());
  Shifted light;  // divisions take longest
  Numbers product;
#pragma GCC ivdep
  for (std::size_t k = 0; k <= at(count); ++k) light[k] = 1 / mass[k];
#pragma GCC ivdep
  for (std::size_t k = 0; k < at(count); ++k) {
    const DoubleDouble rise = two_sum(q[k + 1], -q[k]), rest = two_sum(rise.hi, -s[k]);
    const double slack = rest.hi + (rise.lo + rest.lo);
    product[k] = lambda[k] * slack;
    links.square[k] = light[k] + light[k + 1];
    links.violation[k] = slack < 0 ? -slack : 0;
    links.complementarity[k] = std::abs(lambda[k] * part * slack);
  }
  std::array<double, lanes> sum{};
  add_by_lanes(count, product, sum);
  links.gap = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

MOREAU_CLONES
void divide_links(Index count, const double* s, double q_norm, double scale, Links& links, double& violation,
                  double& complementarity) {
  Numbers over, excess;
#pragma GCC ivdep
  for (std::size_t k = 0; k < at(count); ++k) {
    const double length = std::sqrt(links.square[k]);
    const double size = std::abs(s[k]) + length * q_norm, other = length * scale;
    const double some = other > 0 ? other : 1;
    over[k] = size > 0 ? size : some;
    const double violated = links.violation[k] - violation * over[k],
                 open = links.complementarity[k] - complementarity * over[k];
    excess[k] = violated > open ? violated : open;
  }
  if (!(largest_of(count, excess, 0) > 0)) return;  // divisions take longest
#pragma GCC ivdep
  for (std::size_t k = 0; k < at(count); ++k) {
    links.violation[k] = links.violation[k] / over[k];
    links.complementarity[k] = links.complementarity[k] / over[k];
  }
  violation = largest_of(count, links.violation, violation);
  complementarity = largest_of(count, links.complementarity, complementarity);
}

}  // namespace convex::inline isotonic::chain_kernels
