#pragma once

#include "cli/scene.hpp"
#include "mechanics/warning.hpp"

namespace cli {

/// Solves the problem of the scene by its method. What the doubles of rounded numbers leave open within their
/// rounding is decided on the numbers as they were written, where these are fractions.
mechanics::GaussSolution solve_plainly(const Scene&, const mechanics::GaussOptions&);

/// The exact solution of the scene's numbers, as the method "exact" gives it. Those of a mechanism are
/// rounded: where another answer than that of the default method, which counts their radii, is due to
/// rounding alone, the latter is given, without fractions.
mechanics::CertifiedSolution solve_by_fractions(const Scene&);

/// Solves the scene by `solve`; where the state of a mechanism is singular, again with the equations that
/// higher derivatives add, which then are rows of the scene's problem. The answer that stands is that of the
/// last call. Returns what is to be said of it.
std::vector<mechanics::Warning> resolve_scene(
    Scene& scene, const std::function<const mechanics::GaussSolution&(const Scene&)>& solve);

/// Gives the scene the equations that any force at a singular state of a mechanism needs, as rows of its
/// problem. Returns what is left undecided. Throws InvalidInput where higher derivatives refuse the state.
std::vector<mechanics::Warning> resolve_for_every_force(Scene&);

/// Contacts of which second derivatives do not tell all, and that the answer would violate: then nothing is
/// known of its acceleration, and it is `inaccurate`.
std::optional<mechanics::Warning> violated_at_higher_order(const Scene&, mechanics::GaussSolution&);

/// Counts what the rounding of A, z, U, s of a mechanism amounts to (`count_evaluation_error` of the reports).
/// Where that makes an answer of the default method inaccurate, it is decided on the numbers as they were
/// written, if these are fractions. Returns the bound for A, z, U, s as evaluated, where they are what was
/// solved.
std::optional<double> settle_evaluation_error(const Scene&, mechanics::GaussSolution&);

/// A scene with its answer, and what is proved of that.
struct ProvedScene {
  mechanics::CertifiedSolution found;
  std::vector<mechanics::Warning> warnings;
};

/// Solves the scene by its method, resolves it, and proves the answer where that is asked for, or where the
/// method is "exact": a mechanism's from its text, once the answer stands. Where nothing is proved of a
/// mechanism, the answer is the plain one.
ProvedScene resolve_and_prove(Scene&, bool certify);

}  // namespace cli
