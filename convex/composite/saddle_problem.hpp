#pragma once

#include <vector>

#include "convex/composite/graph_form.hpp"
#include "convex/composite/metric_difference.hpp"

namespace convex::inline composite {

/// A term scale · f(M ξ + b) of a saddle problem: its rows in the stacked M.
struct SaddleTerm {
  std::shared_ptr<const Atom> f;
  double scale = 1;
  Index first = 0, rows = 0;
  SparseMatrix M;
  bool separable = false;
};

/// What the engine solves: minimise over ξ = (x, w), x: n, w: k,
///   ½||x - z||_W² + ½ ξ·Qξ + c·ξ + sum_j scale_j f_j(M_j ξ + b_j),
/// linear and square terms of a graph form being in c and Q. M, b, D are stacked over the terms, m rows.
struct SaddleProblem {
  Index n = 0, k = 0, m = 0;
  Metric W = Metric::identity(0);
  MetricScales scales;
  Vector z;
  Matrix G;               ///< the Hessian of the smooth part, blockdiag(W, 0) + Q: (n+k)×(n+k)
  SparseMatrix sparse_G;  ///< the same, where most of it is 0; else empty
  Matrix Q;               ///< empty when 0
  Vector c;
  std::vector<SaddleTerm> terms;
  SparseMatrix M;
  Vector b;
  Vector D;  ///< m: the metric in which a term's prox is taken, of the size of W as seen through M, in powers
             ///< of 2 so that products with it are exact
  Vector R;  ///< k: the size of a proximal term on w that weighs as much as D
  /// Row i with M ξ + b = x_i + b_row for each x_i, or -1. Where there is one, x_i is taken from the prox.
  std::vector<Index> pin;

  /// M is made of such rows alone, so that v = Mᵀy is a subgradient of f at x.
  bool all_pinned = false;

  Look look;
};

SaddleProblem saddle_problem(const GraphForm& f, const Vector& z, const Metric& W, const Look& look = {});

/// sparse_G of G.
void set_sparse_part(SaddleProblem& problem);

/// R of D, M and Q.
void set_scales_of_w(SaddleProblem& problem);

/// A point of the graphs of the terms' subdifferentials beside a ξ, after Minty: t gives u = prox_D t and
/// y = D(t - u), a subgradient of the term at u. Solved when r and rho are 0.
struct SaddlePoint {
  Vector xi, t, u, y;
  Vector D;             ///< the metric that it was taken in
  Vector r;             ///< M ξ + b - u: m
  Vector rho;           ///< (W(x - z), 0) + Qξ + c + Mᵀy: n + k
  double residual = 0;  ///< of ||rho_x||_(W⁻¹), ||rho_w||_(R⁻¹) and ||r||_D, the root of the sum of squares
};

/// The point of a ξ and a t in a metric D (not always the problem's own); pinned entries of x are replaced.
SaddlePoint saddle_point(const SaddleProblem&, Vector xi, Vector t, const Vector& D);

/// The subgradients of the terms at u by the atoms' own formulas, where they have one; else D(t - u), which
/// of small ones is the rounding of u.
Vector own_covectors(const SaddleProblem&, const SaddlePoint&);

/// What `residual` is relative to: ||x||_W + ||z||_W, ||u||_D and ||y||_(D⁻¹).
double solution_size(const SaddleProblem&, const SaddlePoint&);

/// How far M ξ + b is from u in a row, as a part of the sizes of that row: of rows that hold each by itself,
/// equations and bounds, whose units may be far apart. `around`: the size of ξ.
double largest_miss_of_rows(const SaddleProblem&, const SaddlePoint&, double around);
/// The same of all rows of sets, `around` counted by its rounding alone. Above the membership tolerance a row
/// is open: what counts as nothing beside its largest entry may be all of it, where other entries are far
/// smaller.
double largest_miss_beyond_rounding(const SaddleProblem&, const SaddlePoint&, double around);

/// prox_D of every term at its part of t.
Vector prox_of_terms(const SaddleProblem&, const Vector& t, const Vector& D);
/// M ξ + b - u, rounded once.
Vector mismatch(const SaddleProblem&, const Vector& xi, const Vector& u);
/// (W(x - z), 0) + Qξ + c + MᵀD(t - u), rounded once where D is made of powers of 2.
Vector lagrangian_gradient(const SaddleProblem&, const Vector& xi, const Vector& t, const Vector& u,
                           const Vector& D);

}  // namespace convex::inline composite
