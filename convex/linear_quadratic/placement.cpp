#include "convex/linear_quadratic/placement.hpp"

#include <string>

#include "convex/invalid_input.hpp"

namespace convex::linear_quadratic {

SparseMatrix placement(const LinearQuadratic& f, Index columns, Index first, Entries entries) {
  for (Index j = 0; j < f.auxiliaries(); ++j)
    entries.emplace_back(static_cast<int>(f.n + j), static_cast<int>(first + j), 1.0);
  SparseMatrix T(f.variables(), columns);
  T.setFromTriplets(entries.begin(), entries.end());
  return T;
}

LinearQuadratic placed(const LinearQuadratic& f, Index n, Index columns, Index first, Entries x_entries) {
  return substitute(f, n, placement(f, columns, first, std::move(x_entries)), Vector::Zero(f.variables()));
}

Entries identity_at(Index n, Index column, double factor) {
  Entries entries;
  for (Index i = 0; i < n; ++i)
    entries.emplace_back(static_cast<int>(i), static_cast<int>(column + i), factor);
  return entries;
}

void append(Entries& entries, const Entries& more) {
  entries.insert(entries.end(), more.begin(), more.end());
}

SparseMatrix gram(const Metric& W) {
  if (W.kind() == MetricKind::dense) return W.dense_gram().sparseView();
  if (W.kind() == MetricKind::sparse) return W.sparse_gram();
  SparseMatrix D(W.dimension(), W.dimension());
  Entries entries;
  for (Index i = 0; i < W.dimension(); ++i)
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), W.diagonal()[i]);
  D.setFromTriplets(entries.begin(), entries.end());
  return D;
}

void require(bool holds, const char* where, const char* message) {
  if (!holds) throw InvalidInput(std::string(where) + ": " + message);
}

}  // namespace convex::linear_quadratic
