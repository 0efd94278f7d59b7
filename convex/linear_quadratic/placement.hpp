#pragma once

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"

namespace convex::linear_quadratic {

using Entries = std::vector<Eigen::Triplet<double>>;

/// The map ξ = T η that reads the variables of f off longer ones: its auxiliary variables from `first` on, x
/// by the entries given. columns: how many η there are.
SparseMatrix placement(const LinearQuadratic& f, Index columns, Index first, Entries x_entries);

/// f, a function of n variables, by that map.
LinearQuadratic placed(const LinearQuadratic& f, Index n, Index columns, Index first, Entries x_entries);

/// Entries of factor · identity, n×n, at (0, column).
Entries identity_at(Index n, Index column, double factor);
void append(Entries& entries, const Entries& more);

/// The Gram matrix of a metric, whatever its kind.
SparseMatrix gram(const Metric& W);

/// InvalidInput "where: what; what to do" unless it holds.
void require(bool holds, const char* where, const char* message);

}  // namespace convex::linear_quadratic
