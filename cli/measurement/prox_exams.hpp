#pragma once

#include "cli/measurement/contest.hpp"

/// Proxes with planted answers: x and a subgradient v at x are chosen with few bits, and z = x + W⁻¹v has no
/// rounding.
namespace cli::inline measurement {

/// The functions whose prox in a full metric is charted by its condition.
enum class Charted { norm1, simplex, ball2, second_order_cone };

/// Every way to find prox_f z, 16 coordinates, W = HDHᵀ/16 with Hadamard's H and D of powers of two from 1
/// down to 1/condition (up to 1e12): `auto` (what the language takes), `active-set` on the piecewise
/// quadratic form, `iterative` on the graph form, `both-halves` (x and the conjugate's prox, each a check of
/// the other), and `proximal-gradient` with the plain prox, accelerated, the only way where nobody has the
/// prox in a metric. The error is ||x - x*||_W over max(||x*||_W, ||z||_W).
std::vector<Contest> prox_contests(Charted, double condition);

/// The functions whose plain prox sorts its entries.
enum class Sorting { simplex, ball1, sum_largest };

/// The same ways in the plain metric, entries of z being `gap` apart, or equal (0).
std::vector<Contest> tie_contests(Sorting, double gap);

}  // namespace cli::inline measurement
