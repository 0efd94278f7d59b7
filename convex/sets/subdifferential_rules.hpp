#pragma once

#include "convex/sets/subgradients.hpp"

/// The rules behind `subdifferential`; each returns none for names that it has no rule for.
namespace convex::inline sets::subgradients {

/// From the parts of an operation. Throws InvalidInput where a condition of the calculus is not met, or a
/// part has no rule.
std::optional<Subdifferential> by_calculus(const Call& f, const ExactGram& W, const Fractions& x);

/// ∂(f □ g)(x) = ∂f(u) ∩ ∂g(x - u) for any u that attains the minimum of f(u) + g(x - u), which is one where
/// the two meet (Rockafellar 1970, theorem 23.8 for the conjugates). Throws InvalidInput where none is found.
Subdifferential of_inf_convolution(const Call& f, const ExactGram& W, const Fractions& x);

/// Norms, balls and cones that are round: norm2, group_norm, k_support, ball2, group_ball, the second-order
/// cones. What decides between a corner, an edge and a smooth point is decided in fractions.
std::optional<Subdifferential> of_curved_norm_or_set(const Call& f, const Fractions& x);
/// Functions and sets of matrices: nuclear_norm, max_eigenvalue, neg_log_det, psd_cone, spectraplex.
std::optional<Subdifferential> of_matrix_function(const Call& f, const Fractions& x);
/// The exponential and the power cone and their duals.
std::optional<Subdifferential> of_three_entry_cone(const Call& f, const Fractions& x);

/// A gradient in doubles, of a function that is finite and differentiable everywhere; at 0, of a positively
/// homogeneous function with f(0) = 0, the set whose support function it is.
std::optional<Subdifferential> of_smooth_or_homogeneous(const Call& f, const ExactGram& W,
                                                        const Fractions& x);

}  // namespace convex::inline sets::subgradients
