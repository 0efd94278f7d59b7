#pragma once

#include <optional>

#include "convex/functions/function.hpp"

/// Proxes by cutting planes (Kelley 1960): f is seen through its values and subgradients alone.
namespace convex {

/// Where the parts of a maximum meet beside a point: the least f + ½||. - z||² + ½(stiffness - 1)||. -
/// near||² by cutting planes (Kelley 1960), so near that the parts are lines. Where they meet is known to
/// roundings of x, not to those of slopes and z; a stiffness far above the curvature of the parts keeps the
/// point where it is along the kink. The bound is that of `near`, with the move.
std::optional<Prox> at_kink(const Function& f, const std::optional<Prox>& near, const Vector& z,
                            const Metric& W, double stiffness, const Look& look);

/// The prox of f from values and subgradients alone, however f is made: the least ½||. - z||² above lines
/// below f, and in half-spaces that hold its domain, until f is less than about `enough`² above the lines
/// there. ||x - x*||² is at most what f(x) is above them, and so is what is missing of f(x) + f*(v) = x·v, v
/// = W(z - x). Lines that values elsewhere contradict, as a subgradient of a program may be off, widen the
/// bound by as much. Of few entries.
std::optional<Prox> prox_by_cuts(const Function& f, const Vector& x_0, const Vector& z, const Metric& W,
                                 double enough, const Look& look);

}  // namespace convex
