#pragma once

#include <optional>
#include <vector>

#include "convex/gamma0/function.hpp"

/// Other pairs of a point x and its covector v than the two proxes of a decomposition gave: what rounding
/// spoils in one representation another may keep. Each comes with its own bound of ||x - x*||_W. None where
/// there is no such pair.
namespace convex::inline named_functions {

/// Where rounding left the point outside the domain, or on the far side of the membership tolerance, the
/// nearest point of the domain; the move is part of the bound.
std::optional<Prox> moved_into_domain(const Function& f, const Prox& found, double scale, const Metric& W,
                                      const Look& look);

/// The prox of the conjugate from a prox x of f and its covector v: W⁻¹v is that at x + W⁻¹v, and the proxes
/// of two points are no farther apart than the points.
std::optional<Prox> moreau_partner(const Prox& of_f, const Vector& z, const Metric& W);

/// The prox of f from that of f* at Wz in W⁻¹, with that point as its covector: as the conjugate found it,
/// not as a y of doubles rounds it.
std::optional<Prox> turned(const std::optional<Prox>& dual, const Vector& z, const Metric& W);

/// x and v again, each right to roundings of itself and not of z. x = prox_f (x + V⁻¹v) in every metric V; in
/// V = s W, s = ||v||_(W⁻¹) / ||x||_W, the two are of one size, so that neither drowns the other. The smaller
/// of the two is kept from pass to pass, the larger follows from z. Passes in a V far from W converge slowly
/// where f is much flatter or steeper than s: one comes for each of some metrics between the two, V's first.
/// Before them, where W is diagonal, one with an s for each entry.
std::vector<Prox> balanced(const Function& f, const std::optional<Prox>& near, const Vector& z,
                           const Metric& W, const Look& look);

/// The point with 0 for entries that are nothing beside its bound, which counts them. None
/// where there are none.
std::optional<Prox> without_small_entries(const Prox& found, const Metric& W);

/// The same point with the covector that the function itself has there, where it has only one.
std::optional<Prox> with_slope(const Function& f, const std::optional<Prox>& at, const Vector& z,
                               const Metric& W);

/// The point where W(x - z) + f'(x) = 0 by Newton's method from one near it, with f' as f tells it and its
/// differences: right to roundings of each entry of x where f is smooth there, however far the entries of z
/// are above it. ||x - x*||_W is at most the residual and the root of what f(x) + f*(v) - x·v leaves open.
std::optional<Prox> along_slopes(const Function& f, const std::optional<Prox>& near, const Vector& z,
                                 const Metric& W);

}  // namespace convex::inline named_functions
