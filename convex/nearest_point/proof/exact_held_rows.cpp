#include "convex/nearest_point/proof/exact_held_rows.hpp"

#include <algorithm>

#include "convex/invariant.hpp"

namespace convex::inline proof {

ExactVector ExactHeldRows::point() const {
  IntegerVector right = problem_.z;
  for (Index a : rows_) right.push_back(problem_.s[at(a)]);
  return system_.solve(right);
}

ExactVector ExactHeldRows::direction(const IntegerVector& row) const {
  IntegerVector right = row;
  right.resize(row.size() + rows_.size(), 0);
  return system_.solve(right);
}

void ExactHeldRows::append(Index p) {
  IntegerVector row = problem_.U[at(p)], column;
  for (const Integer& entry : row) column.push_back(-entry);
  const std::size_t size = row.size() + rows_.size();
  row.resize(size, 0);
  column.resize(size, 0);
  rows_.push_back(p);
  if (!system_.append(row, column)) system_ = prepared();
}

void ExactHeldRows::remove(std::size_t k) {
  rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(k));
  if (!system_.remove(problem_.z.size() + k)) system_ = prepared();
}

IntegerSystem ExactHeldRows::prepared() const {
  const std::size_t n = problem_.z.size(), k = rows_.size();
  IntegerRows M(n + k, IntegerVector(n + k, 0));
  for (std::size_t i = 0; i < n; ++i) std::copy(problem_.A[i].begin(), problem_.A[i].end(), M[i].begin());
  for (std::size_t r = 0; r < k; ++r)
    for (std::size_t i = 0; i < n; ++i) {
      M[n + r][i] = problem_.U[at(rows_[r])][i];
      M[i][n + r] = -M[n + r][i];
    }
  auto system = IntegerSystem::prepared(M);
  invariant(system.has_value(), "the KKT system of independent rows is regular modulo some large prime");
  return *std::move(system);
}

}  // namespace convex::inline proof
