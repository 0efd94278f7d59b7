#pragma once

#include "convex/laws/conjugate_laws.hpp"

namespace convex::inline law_checks {

/// Puts a function known by f(x) and f.prox(z, W) to the test of Moreau's theorem and what follows from it
/// (`prox_laws`), at all trial points in all trial metrics of n dimensions. Its prox is taken at its word of
/// a few roundings (`rounding_bound`).
LawReport laws(const Subject& f, Index n);

/// A prox that is known by its point alone. Throws InvalidInput when this has not n entries.
Prox given_prox(Vector x, Index n);

template <Gamma0 F>
LawReport laws(const F& f, Index n = 3) {
  return laws(Subject{[&f](const Vector& x) { return static_cast<double>(f(x)); },
                      [&f](const Vector& z, const Metric& W) {
                        if constexpr (std::same_as<std::remove_cvref_t<decltype(f.prox(z, W))>, Prox>)
                          return f.prox(z, W);
                        else
                          return given_prox(f.prox(z, W), z.size());
                      }},
              n);
}

/// The same for a function of the catalogue, and the laws of its conjugate and its subgradients besides.
LawReport laws(const Function& f, Index n);

/// And for a claimed conjugate pair: f, and g for each metric.
LawReport laws(const Subject& f, const std::function<Subject(const Metric&)>& conjugate, Index n,
               bool cone = false);

/// The laws at the points and in the metrics given.
LawReport laws(const Function& f, const std::vector<Vector>& points, const std::vector<NamedMetric>& metrics);

}  // namespace convex::inline law_checks
