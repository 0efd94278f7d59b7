#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <string>
#include <vector>

#include "convex/cones/polyhedral_cone.hpp"

namespace oracles {

using FractionRow = std::vector<mpq_class>;

inline FractionRow fractions(const convex::IntegerVector& v) {
  FractionRow row;
  for (const convex::Integer& entry : v) row.emplace_back(entry.text());
  return row;
}

inline FractionRow fractions(const convex::ExactVector& x) {
  FractionRow row = fractions(x.numerators);
  for (mpq_class& entry : row) entry /= mpq_class(x.denominator.text());
  return row;
}

inline FractionRow fractions(const convex::Vector& x) { return {x.begin(), x.end()}; }

inline mpq_class dot(const FractionRow& a, const FractionRow& b) {
  mpq_class sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Gauss-Jordan elimination with pivots in the first columns only; returns how many there are. Pivot k ends
/// in row k.
inline std::size_t eliminate(std::vector<FractionRow>& rows, std::size_t pivot_columns) {
  std::size_t rank = 0;
  for (std::size_t c = 0; c < pivot_columns && rank < rows.size(); ++c) {
    std::size_t p = rank;
    while (p < rows.size() && rows[p][c] == 0) ++p;
    if (p == rows.size()) continue;
    std::swap(rows[rank], rows[p]);
    const mpq_class pivot = rows[rank][c];
    for (mpq_class& entry : rows[rank]) entry /= pivot;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i == rank || rows[i][c] == 0) continue;
      const mpq_class factor = rows[i][c];
      for (std::size_t j = 0; j < rows[i].size(); ++j) rows[i][j] -= factor * rows[rank][j];
    }
    ++rank;
  }
  return rank;
}

inline std::size_t rank(std::vector<FractionRow> rows) {
  return rows.empty() ? 0 : eliminate(rows, rows.front().size());
}

/// Which points are in the cone of the vectors, by Caratheodory's theorem (1907): those that are a
/// combination with coefficients >= 0 of some independent ones. Every choice is tried.
inline std::vector<bool> in_cone(const std::vector<FractionRow>& vectors,
                                 const std::vector<FractionRow>& points) {
  std::vector<bool> inside(points.size(), false);
  const std::size_t r = rank(vectors), n = points.empty() ? 0 : points.front().size();
  std::vector<bool> taken(vectors.size(), false);
  std::fill(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(r), true);
  do {
    std::vector<FractionRow> system(n, FractionRow(r + points.size()));
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t column = 0;
      for (std::size_t k = 0; k < vectors.size(); ++k)
        if (taken[k]) system[i][column++] = vectors[k][i];
      for (std::size_t p = 0; p < points.size(); ++p) system[i][r + p] = points[p][i];
    }
    if (eliminate(system, r) < r) continue;
    for (std::size_t p = 0; p < points.size(); ++p) {
      bool good = true;
      for (std::size_t i = 0; i < n; ++i)
        good = good && (i < r ? system[i][r + p] >= 0 : system[i][r + p] == 0);
      if (good) inside[p] = true;
    }
  } while (std::prev_permutation(taken.begin(), taken.end()));
  return inside;
}

}  // namespace oracles
