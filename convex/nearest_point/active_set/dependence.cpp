#include "convex/nearest_point/active_set/dependence.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/reductions/islands.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline dual_active_set {
namespace {

/// Beyond so many multiplications there is no dense factor of tight rows.
constexpr double most_dense_work = 3e9;

bool is_small_enough(Index coordinates, std::size_t rows) {
  const double n = static_cast<double>(coordinates), k = static_cast<double>(rows);
  return n * k * std::min(n, k) <= most_dense_work;
}

double radius_of(const NearestPointProblem& problem, Index row) {
  return problem.radii ? problem.radii->row[row] : 0;
}

Dependence dependence(const NearestPointProblem& problem, const std::vector<Index>& basis,
                      const std::vector<Index>& tight) {
  using Set = WorkingSet;
  Set set(problem);
  set.append_block(basis, 0);
  Dependence found;
  Set::Split split;
  struct Told {
    Vector coefficients;  // rows taken in later have no part in them
    double turn = 0;      // what the radii of the rows may make of their sum
  };
  std::vector<Told> expansions;
  for (Index a : tight) {
    if (set.holds(a)) continue;
    set.split(a, split);
    if (split.rho > 0) {
      set.append(a, split, 0);
      continue;
    }
    found.dependent.push_back(a);
    const double noise = 64 * unit_roundoff * split.magnitude;  // of a coefficient times its row's length
    Told& told = expansions.emplace_back(Told{Vector::Zero(set.size()), radius_of(problem, a)});
    for (Index k = 0; k < set.size(); ++k) {
      if (!(std::abs(split.coefficients[k]) * set.factor().length(k) > noise)) continue;
      told.coefficients[k] = split.coefficients[k];
      told.turn += std::abs(split.coefficients[k]) * radius_of(problem, set.rows()[at(k)]);
    }
  }
  found.basic = set.rows();
  found.inverse_norm = set.factor().inverse_norm();
  found.T = Matrix::Zero(set.size(), static_cast<Index>(found.dependent.size()));
  const bool are_rounded =
      std::any_of(expansions.begin(), expansions.end(), [](const Told& told) { return told.turn > 0; });
  const Matrix inverse = are_rounded ? set.factor().inverse() : Matrix();
  for (std::size_t p = 0; p < expansions.size(); ++p) {
    const auto& [coefficients, turn] = expansions[p];
    const Index size = coefficients.size();
    // A row that turns by a vector of length 1 changes its coefficients by the lengths of the rows of R⁻¹.
    for (Index k = 0; k < size; ++k)
      if (!(turn > 0 && std::abs(coefficients[k]) <= turn * inverse.row(k).head(size).norm()))
        found.T(k, static_cast<Index>(p)) = coefficients[k];
  }
  return found;
}

/// The groups of rows that nonzero entries of T tie together, each with its part of T.
void split_by_ties(const Dependence& whole, std::vector<Dependence>& groups) {
  const Index k = whole.T.rows(), d = whole.T.cols();
  std::vector<Index> group_of_row(at(k), -1);
  std::vector<bool> seen(at(d), false);
  for (Index first = 0; first < d; ++first) {
    if (seen[at(first)]) continue;
    std::vector<Index> rows, columns{first};
    seen[at(first)] = true;
    for (std::size_t next = 0; next < columns.size(); ++next)
      for (Index r = 0; r < k; ++r) {
        if (whole.T(r, columns[next]) == 0 || group_of_row[at(r)] >= 0) continue;
        group_of_row[at(r)] = first;
        rows.push_back(r);
        for (Index p = 0; p < d; ++p) {
          if (whole.T(r, p) == 0 || seen[at(p)]) continue;
          seen[at(p)] = true;
          columns.push_back(p);
        }
      }
    std::sort(rows.begin(), rows.end());
    std::sort(columns.begin(), columns.end());
    Dependence group;
    for (Index r : rows) group.basic.push_back(whole.basic[at(r)]);
    for (Index p : columns) group.dependent.push_back(whole.dependent[at(p)]);
    group.T = whole.T(rows, columns);
    group.inverse_norm = whole.inverse_norm;
    groups.push_back(std::move(group));
  }
}

void rename(std::vector<Index>& rows, const std::vector<Index>& names) {
  for (Index& row : rows) row = names[at(row)];
}

}  // namespace

std::optional<std::vector<Dependence>> dependences(const NearestPointProblem& problem,
                                                   const std::vector<Index>& basis,
                                                   const std::vector<Index>& tight) {
  std::vector<Dependence> groups;
  if (tight.size() == basis.size()) return groups;
  constexpr std::size_t few = 64;
  if (tight.size() <= few && is_small_enough(problem.dimension(), tight.size())) {
    split_by_ties(dependence(problem, basis, tight), groups);
    return groups;
  }
  // Rows that share no coordinate do not depend on each other, whatever A couples.
  const Index k = static_cast<Index>(tight.size());
  const NearestPointProblem held{
      Metric::diagonal(problem.A.diagonal()), problem.z, problem.U.select(tight), Vector::Zero(k), {}};
  const IslandLists islands = list_islands(find_islands(held));
  const std::vector<bool> in_basis = marked(problem.rows(), basis);
  std::vector<Index> place(at(problem.dimension()));
  for (std::size_t i = 0; i < islands.rows.size(); ++i) {
    std::vector<Index> names, own_basis;
    for (std::size_t r = 0; r < islands.rows[i].size(); ++r) {
      names.push_back(tight[at(islands.rows[i][r])]);
      if (in_basis[at(names.back())]) own_basis.push_back(static_cast<Index>(r));
    }
    if (own_basis.size() == names.size()) continue;
    if (!is_small_enough(static_cast<Index>(islands.coordinates[i].size()), names.size()))
      return std::nullopt;
    const bool is_whole = islands.rows[i].size() == tight.size() && islands.coordinates.size() == 1;
    Dependence found = is_whole
                           ? dependence(problem, basis, tight)
                           : dependence(island_problem(held, islands.coordinates[i], islands.rows[i], place),
                                        own_basis, indices_below(static_cast<Index>(names.size())));
    if (!is_whole) {
      rename(found.basic, names);
      rename(found.dependent, names);
    }
    split_by_ties(found, groups);
  }
  return groups;
}

double inverse_norm_of_rows(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  constexpr double quick_work = 1e7;
  const double n = static_cast<double>(problem.dimension()), k = static_cast<double>(rows.size());
  if (n * (n + k * k) > quick_work) return 1;
  WorkingSet set(problem);
  set.append_block(rows, 0);
  return std::max(1.0, set.factor().inverse_norm());
}

std::vector<NullVector> null_space(const std::vector<Dependence>& groups) {
  std::vector<NullVector> found;
  for (const Dependence& group : groups)
    for (std::size_t p = 0; p < group.dependent.size(); ++p) {
      NullVector mu{{group.dependent[p], 1.0}};
      for (std::size_t k = 0; k < group.basic.size(); ++k) {
        const double coefficient = group.T(static_cast<Index>(k), static_cast<Index>(p));
        if (coefficient != 0) mu.emplace_back(group.basic[k], -coefficient);
      }
      std::sort(mu.begin(), mu.end());
      found.push_back(std::move(mu));
    }
  std::sort(found.begin(), found.end(), [](const NullVector& a, const NullVector& b) { return a < b; });
  return found;
}

}  // namespace convex::inline dual_active_set
