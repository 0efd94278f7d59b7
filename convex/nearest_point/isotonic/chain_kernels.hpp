#pragma once

#include <array>

#include "convex/vector.hpp"

/// What members of a chain do alone, a block of them at a time, by loops that are compiled for several
/// processors.
namespace convex::inline isotonic::chain_kernels {

/// Members of a block, and sums kept side by side.
inline constexpr Index width = 128, lanes = 4;

using Numbers = std::array<double, width>;
using Shifted = std::array<double, width + 1 + lanes>;  ///< a place for the member before, and some to spare

/// Members from `first` on. Of the row above each: factor, what it pushes with, the largest term of
/// that sum, lambda, and their product.
struct Block {
  Index first, count;
  const double *mass, *linear;
  Numbers mass_list, linear_list, factor, goes_on, inertia, plain_hi, plain_lo, left_hi, left_lo, pushed,
      largest, lambda;
  Shifted x_hi, x_lo, load_hi, load_lo;
};

struct Squares {
  std::array<double, lanes> unbalanced{}, q{}, z{}, lost{};
};

/// How many of the pairs of values are -c, c with c > 0; adds to `ones` those with c = 1.
Index count_links(Index count, const double* values, Index& ones);
/// hi + lo as pairs with |lo| <= u |hi|.
void make_tidy(Index count, double* hi, double* lo);
/// x += offset, of pairs.
void lift(Block&, const double* offset_hi, const double* offset_lo);
/// linear - mass offset, as a pair.
void lower(Index count, const double* mass, const double* linear, const double* offset_hi,
           const double* offset_lo, double* hi, double* lo);
/// linear - mass x, and its parts.
void weigh(Block&);
/// What rows push with is 0 within the rounding of its sum; how many would have to pull.
Index drop_rounding(Block&);
/// lambda from what the rows push with.
void divide(Block&);
/// The same where all factors are 1.
void copy(Block&);
/// What is out of balance as the numbers are printed, and the norms.
void judge(Block&, Squares&);

/// Of rows q_(k+1) - q_k >= s_k: ||u_k||² in the metric A⁻¹, what is violated and |lambda/largest slack|;
/// and Σ lambda_k slack_k. Slacks are in twice the working precision.
struct Links {
  Numbers square, violation, complementarity;
  double gap;
};
void measure_links(Index count, const double* mass, const double* q, const double* s, const double* lambda,
                   double largest, Links&);
/// The largest of the last two over |s_k| + ||u_k|| q_norm, or over ||u_k|| scale where that is 0, as far as
/// they are more than those given.
void divide_links(Index count, const double* s, double q_norm, double scale, Links&, double& violation,
                  double& complementarity);

}  // namespace convex::inline isotonic::chain_kernels
