#pragma once

#include <string>
#include <vector>

#include "convex/metric.hpp"

namespace convex::inline law_checks {

/// A point and a metric in which a law is tried.
struct Trial {
  Vector z;
  Metric W;
  std::string metric_name;
};

/// The metrics of the trials in n dimensions: identity, diagonal, dense, and dense with condition 1e6. Throws
/// InvalidInput when n < 1, as `trial_points` does.
struct NamedMetric {
  std::string name;
  Metric W;
};
std::vector<NamedMetric> trial_metrics(Index n);

/// Points at which wrong functions betray themselves: the origin, ties, whole numbers of both signs, one
/// large entry, random ones near (where most errors are) and far away. Always the same ones.
std::vector<Vector> trial_points(Index n);

/// Symmetric, of the condition given, with eigenvectors in general position.
Matrix matrix_of_condition(Index n, double condition);

/// The smallest and the largest eigenvalue of W.
struct Spectrum {
  double smallest = 1, largest = 1;
  double condition() const { return largest / smallest; }
};
Spectrum spectrum(const Metric& W);
Matrix gram_matrix(const Metric& W);

/// What rounding may do to a prox at z with result x, in the norm of W: solving with W leaves
/// 4 u n condition(W) (||z||_W + ||x||_W) (Higham 2002, Theorem 10.4).
double rounding_bound(const Metric& W, const Vector& z, const Vector& x);

}  // namespace convex::inline law_checks
