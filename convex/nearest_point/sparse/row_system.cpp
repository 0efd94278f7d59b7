#include "convex/nearest_point/sparse/row_system.hpp"

namespace convex::inline sparse {
namespace {

/// A row with more entries than this, whose square would be a dense block of that size, is put on the border.
constexpr Index short_row = 12;

/// Up to this distance from the diagonal a band is factored faster than the same numbers in panels.
constexpr Index narrow_band = 16;

}  // namespace

RowSystem::Pattern RowSystem::pattern(const BalancedProblem& problem) {
  Pattern found;
  const Index n = problem.A.rows();
  for (Index j = 0; j < n; ++j)
    for (SparseMatrix::InnerIterator it(problem.A, j); it; ++it) {
      if (it.row() < j) continue;
      found.places.push_back({static_cast<int>(it.row()), static_cast<int>(j)});
      found.of_A.push_back(it.value());
    }
  for (Index a = 0; a < problem.U.rows(); ++a) {
    found.first.push_back(static_cast<Index>(found.of_rows.size()));
    const Index entries = problem.U.outerIndexPtr()[a + 1] - problem.U.outerIndexPtr()[a];
    if (entries > short_row) {
      found.long_rows.push_back(a);
      continue;
    }
    for (SparseRows::InnerIterator i(problem.U, a); i; ++i)
      for (SparseRows::InnerIterator j = i; j; ++j) {
        found.places.push_back({static_cast<int>(i.col()), static_cast<int>(j.col())});
        found.of_rows.push_back(i.value() * j.value());
      }
  }
  found.first.push_back(static_cast<Index>(found.of_rows.size()));
  for (std::size_t k = 0; k < found.long_rows.size(); ++k) {
    const int border = static_cast<int>(n) + static_cast<int>(k);
    for (SparseRows::InnerIterator it(problem.U, found.long_rows[k]); it; ++it) {
      found.places.push_back({border, static_cast<int>(it.col())});
      found.of_border.push_back(it.value());
    }
    found.border_entries.push_back(problem.U.outerIndexPtr()[found.long_rows[k] + 1] -
                                   problem.U.outerIndexPtr()[found.long_rows[k]]);
    found.places.push_back({border, border});
  }
  return found;
}

std::variant<linear_algebra::SparseFactor, linear_algebra::BandFactor> RowSystem::analysed(
    Index n, const std::vector<linear_algebra::SparseFactor::Place>& places) {
  const Index width = linear_algebra::BandFactor::width(places);
  if (width <= narrow_band) return linear_algebra::BandFactor(n, width);
  return linear_algebra::SparseFactor(n, places);
}

RowSystem::RowSystem(const BalancedProblem& problem) : RowSystem(problem, pattern(problem)) {}

RowSystem::RowSystem(const BalancedProblem& problem, Pattern found)
    : n_(problem.A.rows()),
      pattern_(std::move(found)),
      factor_(analysed(n_ + static_cast<Index>(pattern_.long_rows.size()), pattern_.places)),
      slots_(std::visit([&](const auto& factor) { return factor.slots(pattern_.places); }, factor_)) {
  pattern_.places.clear();
  pattern_.places.shrink_to_fit();
}

bool RowSystem::factor(const Vector& weight) {
  double* values = std::visit(
      [](auto& factor) {
        factor.clear_values();
        return factor.values().data();
      },
      factor_);
  const Index* slot = slots_.data();
  for (double a : pattern_.of_A) values[*slot++] += a;
  const Index m = static_cast<Index>(pattern_.first.size()) - 1;
  for (Index a = 0; a < m; ++a) {
    const Index end = pattern_.first[at(a) + 1];
    for (Index k = pattern_.first[at(a)]; k < end; ++k)
      values[*slot++] += weight[a] * pattern_.of_rows[at(k)];
  }
  // A row without weight is cut off.
  std::size_t entry = 0;
  for (std::size_t k = 0; k < pattern_.long_rows.size(); ++k) {
    const double w = weight[pattern_.long_rows[k]];
    for (Index i = 0; i < pattern_.border_entries[k]; ++i, ++entry)
      values[*slot++] += w > 0 ? pattern_.of_border[entry] : 0;
    values[*slot++] += w > 0 ? -1 / w : -1;
  }
  ++factorisations_;
  return std::visit([](auto& factor) { return factor.factor(); }, factor_);
}

Vector RowSystem::solve(const Vector& r) const {
  return std::visit(
      [&](const auto& factor) {
        Vector x = Vector::Zero(factor.dimension());
        x.head(n_) = r;
        factor.solve(x);
        return Vector(x.head(n_));
      },
      factor_);
}

double RowSystem::flops() const {
  return std::visit([](const auto& factor) { return factor.flops(); }, factor_);
}

double RowSystem::nonzeros() const {
  return std::visit([](const auto& factor) { return factor.nonzeros(); }, factor_);
}

}  // namespace convex::inline sparse
