#pragma once

#include <span>

#include "convex/composite/graph_form.hpp"
#include "convex/metric.hpp"

/// Operations on graph forms; exact as functions, by auxiliary variables and linear terms. Sizes are the
/// callers' to check (`invariant`).
namespace convex::inline composite {

/// One atom: f(x) itself.
GraphForm graph_of(std::shared_ptr<const Atom> f, Index n);

/// f_1 + f_2 + …, all of one n.
GraphForm sum(std::span<const GraphForm> f);
/// alpha f, alpha > 0.
GraphForm scale(GraphForm f, double alpha);
/// x -> f(Ax + b). A: f.n × n, b: f.n.
GraphForm precompose(const GraphForm& f, const SparseMatrix& A, const Vector& b);
/// f + ½ x·Qx + c·x + constant, Q: n×n positive semidefinite.
GraphForm add_quadratic(GraphForm f, const Matrix& Q, const Vector& c, double constant);
/// f_1(x_1) + f_2(x_2) + … over consecutive blocks of x.
GraphForm blocks(std::span<const GraphForm> f);
/// inf over w of f(x - w) + g(w).
GraphForm inf_convolution(const GraphForm& f, const GraphForm& g);
/// inf over w of f(w) + ½||x - w||_W² / gamma, W and gamma kept apart.
GraphForm envelope(const GraphForm& f, const Metric& W, double gamma = 1);
/// max_i f_i(x) = min {t : (x, t) in every epigraph}, by epigraphs of the atoms. `slope`: of the size of a
/// subgradient where the form is used; heights are measured in it, so that x and t are of one size there.
GraphForm pointwise_max(std::span<const GraphForm> f, double slope = 1);
/// The indicator of {(x, t) : f(x) <= t}, n + 1 entries; slope as above.
GraphForm epigraph(const GraphForm& f, double slope = 1);
/// (x, s) -> s f(x/s) for s > 0, its closure at s = 0, +inf for s < 0: n + 1 entries, by perspectives of the
/// atoms.
GraphForm perspective(const GraphForm& f);
/// f*(y) = sup_x y·x - f(x): min over p of sum_j scale_j f_j*(p_j / scale_j) - b_j·p_j over the p with
/// sum_j M_jᵀ p_j = (y, 0) (Rockafellar 1970, Theorems 16.3 and 16.4); of f's closure where no point is
/// inside every domain. p_j is eliminated for a term whose M_j is the identity on x.
GraphForm conjugate(const GraphForm& f);
/// The proximal average of Bauschke, Lucet and Trienis (2008), lambda in (0, 1) the weight of f:
///   inf {lambda f(p) + (1-lambda) g(w) + lambda (1-lambda)/(2 gamma) ||p - w||_W² : lambda p + (1-lambda) w
///   = x}.
GraphForm proximal_average(const GraphForm& f, const GraphForm& g, double lambda, double gamma,
                           const Metric& W);

}  // namespace convex::inline composite
