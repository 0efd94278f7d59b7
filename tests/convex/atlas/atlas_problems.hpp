#pragma once

#include <random>
#include <vector>

#include "convex/nearest_point/proof/exact_problem.hpp"

namespace tests {

/// Rows of small integers.
inline convex::ExactRows integer_rows(const std::vector<std::vector<int>>& rows) {
  convex::ExactRows made;
  for (const std::vector<int>& row : rows) made.push_back({convex::IntegerVector(row.begin(), row.end()), 1});
  return made;
}

inline convex::ExactProblem atlas_problem(const std::vector<std::vector<int>>& A,
                                          const std::vector<std::vector<int>>& U, const std::vector<int>& s,
                                          std::vector<convex::Index> two_sided = {}) {
  return convex::exact_problem(integer_rows(A), {convex::IntegerVector(A.size(), 0), 1}, integer_rows(U),
                               {convex::IntegerVector(s.begin(), s.end()), 1}, std::move(two_sided));
}

/// Boxes and orthants, cones with more rows than dimensions, rows that are redundant, dependent, two-sided or
/// equalities in disguise, fewer rows than coordinates, and random polyhedra.
inline std::vector<convex::ExactProblem> atlas_problems() {
  std::vector<convex::ExactProblem> problems{
      atlas_problem({{2, 1}, {1, 2}}, {{1, 0}, {0, 1}}, {0, 0}),
      atlas_problem({{2, 1}, {1, 2}}, {{1, 0}, {-1, 0}, {0, 1}, {1, 1}}, {-1, -2, 0, -1}),
      atlas_problem({{3, 0, 1}, {0, 2, 0}, {1, 0, 1}}, {{1, 1, 1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}},
                    {0, 0, 0, 0}),
      atlas_problem({{3, 0, 1}, {0, 2, 0}, {1, 0, 1}}, {{1, 2, 0}, {1, 2, 0}, {0, 1, 0}}, {0, 1, 1}),
      atlas_problem({{3, 0, 1}, {0, 2, 0}, {1, 0, 1}}, {{1, 0, 0}, {0, 1, 1}, {1, 1, 1}}, {1, 0, 1}, {1}),
      atlas_problem({{1, 0}, {0, 1}}, {{1, 0}, {-1, 0}, {0, 1}}, {0, 0, 0}),
      atlas_problem({{1, 0}, {0, 1}}, {}, {}),
  };
  std::mt19937 random(7);
  std::uniform_int_distribution<int> entry(-4, 4);
  for (const auto& [n, m] : {std::pair{2, 5}, {3, 5}, {3, 7}, {4, 6}, {5, 6}, {4, 3}}) {
    std::vector<std::vector<int>> A(static_cast<std::size_t>(n),
                                    std::vector<int>(static_cast<std::size_t>(n)));
    std::vector<std::vector<int>> factor = A, U;
    for (auto& row : factor)
      for (int& number : row) number = entry(random);
    for (std::size_t i = 0; i < A.size(); ++i)
      for (std::size_t j = 0; j < A.size(); ++j) {
        A[i][j] = i == j ? 3 : 0;
        for (std::size_t k = 0; k < A.size(); ++k) A[i][j] += factor[i][k] * factor[j][k];
      }
    std::vector<int> s;
    for (int a = 0; a < m; ++a) {
      U.emplace_back();
      for (int i = 0; i < n; ++i) U.back().push_back(entry(random));
      s.push_back(-std::abs(entry(random)));
    }
    problems.push_back(atlas_problem(A, U, s));
  }
  return problems;
}

}  // namespace tests
