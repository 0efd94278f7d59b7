#pragma once

#include <optional>

#include "convex/gamma0/function.hpp"

/// Proxes by cutting planes (Kelley 1960): f is seen through its values and subgradients alone.
namespace convex::inline decompositions {

/// Where the parts of a maximum meet beside a point: the least f + ½||. - z||² + ½(stiffness - 1)||. -
/// near||² by cutting planes (Kelley 1960), so near that the parts are lines. Where they meet is known to
/// roundings of x, not to those of slopes and z; a stiffness far above the curvature of the parts keeps the
/// point where it is along the kink. The bound is that of `near`, with the move.
std::optional<Prox> at_kink(const Function& f, const std::optional<Prox>& near, const Vector& z,
                            const Metric& W, double stiffness, const Look& look);

/// The prox of f from values and subgradients alone, however f is made: the least ½||. - z||² above lines
/// below f, and in half-spaces that hold it where it is the indicator of a set, until f is less than about
/// `enough`² above the lines there. The bound is an estimate, and so are the values of f at x and of f* at v:
/// they take subgradients at their word but for what values seen elsewhere contradict, and points that a set
/// takes in by its tolerance for points of it. Who tells the point holds it against values of f and f*. Of
/// few entries.
std::optional<Prox> prox_by_cuts(const Function& f, const Vector& x_0, const Vector& z, const Metric& W,
                                 double enough, const Look& look);

}  // namespace convex::inline decompositions
