#include "mechanics/singular/suspect_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "convex/linear_algebra/pivoted_qr.hpp"

namespace mechanics::inline singular_states {
namespace {

using convex::Matrix;

/// Closer to a dependence than this part of the rows themselves, and radii are asked.
constexpr double close = 1e-6;

/// Multiplications that the look at a group may cost: some milliseconds.
constexpr double most_work = 2e7;

struct Entry {
  Index column;
  double value;
};

std::vector<Entry> entries(const convex::ConstraintRows& U, Index row) {
  std::vector<Entry> found;
  U.for_each_entry(row, [&](Index i, double value) { found.push_back({i, value}); });
  return found;
}

Index root_of(std::vector<Index>& parent, Index x) {
  while (parent[static_cast<std::size_t>(x)] != x) {
    parent[static_cast<std::size_t>(x)] =
        parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(x)])];
    x = parent[static_cast<std::size_t>(x)];
  }
  return x;
}

}  // namespace

SuspectRows suspect_rows(const GaussProblem& gauss, const Vector& unit) {
  const convex::ConstraintRows& U = gauss.problem.U;
  const std::vector<Index>& two_sided = gauss.problem.two_sided;
  SuspectRows found;
  // Groups of rows that share coordinates; `parent` joins the coordinates.
  std::vector<Index> parent(static_cast<std::size_t>(U.dimension()));
  std::iota(parent.begin(), parent.end(), Index{0});
  std::vector<std::vector<Entry>> rows;
  for (const Index row : two_sided) {
    rows.push_back(entries(U, row));
    for (const Entry& entry : rows.back())
      parent[static_cast<std::size_t>(root_of(parent, entry.column))] =
          root_of(parent, rows.back()[0].column);
  }
  std::map<Index, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Index constraint = gauss.contacts.present[static_cast<std::size_t>(two_sided[k])];
    double largest = 0;
    for (const Entry& entry : rows[k]) largest = std::max(largest, std::abs(entry.value));
    if (largest <= close * gauss.contacts.rates.f_scale[constraint]) found.rows.push_back(two_sided[k]);
    if (!rows[k].empty()) groups[root_of(parent, rows[k][0].column)].push_back(k);
  }
  for (const auto& [root, members] : groups) {
    if (members.size() < 2) continue;
    std::map<Index, Index> column_of;
    for (const std::size_t k : members)
      for (const Entry& entry : rows[k])
        column_of.emplace(entry.column, static_cast<Index>(column_of.size()));
    const auto m = static_cast<Index>(members.size()), n = static_cast<Index>(column_of.size());
    if (static_cast<double>(m) * static_cast<double>(m) * static_cast<double>(n) > most_work) {
      for (const std::size_t k : members) found.unseen.push_back(two_sided[k]);
      continue;
    }
    Matrix V = Matrix::Zero(n, m);
    for (Index k = 0; k < m; ++k)
      for (const Entry& entry : rows[members[static_cast<std::size_t>(k)]])
        V(column_of[entry.column], k) = entry.value * unit[entry.column];
    V.colwise().normalize();
    const bool dependent = m > n || !(convex::linear_algebra::PivotedQr(V).pivots[m - 1] > close);
    if (dependent)
      for (const std::size_t k : members) found.rows.push_back(two_sided[k]);
  }
  std::sort(found.rows.begin(), found.rows.end());
  found.rows.erase(std::unique(found.rows.begin(), found.rows.end()), found.rows.end());
  std::sort(found.unseen.begin(), found.unseen.end());
  return found;
}

}  // namespace mechanics::inline singular_states
