#pragma once

#include <string>

#include "convex/exact_program/exact_minimum.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/interval.hpp"
#include "convex/nearest_point/proof/certificate.hpp"
#include "convex/proved_prox/proof_pair.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {

/// A point to split, its numbers as they are written: z = x + y, x = prox_f z, y = prox_g z, g(y) = f*(Wy).
struct SplitQuestion {
  Call f;
  Fractions z;
  ExactGram W;
};

/// What a pair x, v proves about the exact x* = prox_f z and y* = z - x*: with y = W⁻¹v,
///   ½||x - x*||² + ½||y - y*||² <= f(x) + f*(v) - x·v + ½||W(z - x) - v||²_(W⁻¹),
/// whatever x and v are (docs/theory.md, C.9). A number above the root of twice the right side, every term
/// enclosed; infinite where the metric is not proved definite.
double proved_radius(const ProvedMetric& W, const Fractions& z, const ProofPair& pair);

/// [low, high] in doubles, rounded outwards.
struct ProvedInterval {
  double low = 0, high = 0;
};

ProvedInterval outwards(const Fraction& low, const Fraction& high);

/// ||x - x*||_W <= x_bound and ||y - y*||_W <= y_bound for the doubles x and y as they stand: each from a
/// pair of its own, the first near x and its covector, the second near the covector of g at y and Wy, so that
/// neither knows of the other. f(x*), g(y*) and (x*|y*) lie in the intervals.
struct ProvedSplit {
  ProofLevel level = ProofLevel::none;
  double x_bound = INFINITY, y_bound = INFINITY;
  ProvedInterval f_x, g_y, inner;
  /// ||z - x - y||_W rounded up: at most x_bound + y_bound, for x* + y* = z; else nothing is claimed.
  double sum_miss = INFINITY;
  std::string why_none;  ///< of level none, in words
  double error_bound() const { return std::max(x_bound, y_bound); }
};

/// Proves what it can of a decomposition in doubles. `split.x.v` and `split.y.v` are used where they are
/// there, else W(z - x) and W(z - y). In fractions, and level `exact`, where f is piecewise linear-quadratic
/// and the work is small beside reading the question; else in doubles where these prove ten digits, else in
/// fractions and balls.
ProvedSplit prove(const SplitQuestion&, const Decomposition& split);
/// The same for z and W as they stand, doubles first whatever f is: some times the price of the
/// decomposition.
ProvedSplit prove(const Call& f, const Vector& z, const Metric& W, const Decomposition& split);

/// The decomposition in fractions, of a piecewise linear-quadratic f: x* from the program of f and y* from
/// that of its conjugate, each by itself; that they add up to z is looked at.
struct ExactSplit {
  Fractions x, y;
  Fraction f_x, g_y, inner;
};
/// Throws InvalidInput when f is not piecewise linear-quadratic, or W not positive definite.
ExactSplit exact_split(const SplitQuestion&);
/// The same where it takes no more than `most` word operations, by their count beforehand; none where it
/// would, or f is not piecewise linear-quadratic, or not proper before rounding.
std::optional<ExactSplit> exact_split_within(const SplitQuestion&, double most);

/// What is known of the doubles of a decomposition beside the exact one: all of it.
ProvedSplit proof_of(const ExactSplit&, const Decomposition& split, const SplitQuestion&);

/// A decomposition whose numbers are the nearest doubles of exact ones.
Decomposition rounded(const ExactSplit&, const SplitQuestion&);

}  // namespace convex::inline proved_prox
