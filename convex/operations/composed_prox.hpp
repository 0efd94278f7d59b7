#pragma once

#include <span>
#include <vector>

#include "convex/gamma0/function.hpp"

/// Proxes of sums by the proxes of their parts.
namespace convex::inline operations {

/// prox^W z of f_1 + f_2 + … as one prox after another, prox_f ∘ prox_g: right where ∂g(u) lies in
/// ∂g(prox_f u) for all u (Yu 2013, "On decomposing the proximal map", Theorem 1), W a multiple of the
/// identity. Known cases: f radial, which shortens u, and g positively homogeneous (Theorem 4 there); f the
/// same function of each entry, which keeps their order, and g `by_order` (Bach 2013, section 8.2; for
/// total_variation and norm1 Friedman, Hastie, Höfling and Tibshirani 2007). None where no order of the parts
/// is such a case.
std::optional<Prox> composed_prox(std::span<const Function> parts, const Vector& z, const Metric& W,
                                  const Look& look);

/// prox^W z of f(x) = Σ_i f_i(x_i), n > 1, from those of the f_i, W diagonal; none where the f_i are not
/// known.
std::optional<Prox> prox_by_entries(const FunctionNode& f, const Vector& z, const Metric& W,
                                    const Look& look);

/// Σ_i f_i(x_i) + constant from the f_i, n > 1; none where they or the constant are not known. A program for
/// all entries together is no more accurate for one than for the one with the largest numbers.
std::optional<Value> value_by_entries(const FunctionNode& f, const Vector& x);
/// And a subgradient there.
std::optional<Vector> subgradient_by_entries(const FunctionNode& f, const Vector& x);

/// The prox of f_1(x_1) + f_2(x_2) + … over consecutive blocks, from those of the blocks, not empty. No x
/// where a block has none.
Prox joined(const std::vector<Prox>& blocks);

}  // namespace convex::inline operations
