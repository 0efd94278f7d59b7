#include "convex/exact/determinant_sign.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "convex/exact/fraction.hpp"
#include "tests/oracles/brute_force_cone.hpp"

using convex::IntegerRows;
using convex::IntegerVector;

namespace {

/// By Laplace's expansion along the first row.
mpq_class determinant(const std::vector<oracles::FractionRow>& rows) {
  if (rows.empty()) return 1;
  mpq_class sum = 0;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    std::vector<oracles::FractionRow> minor(rows.begin() + 1, rows.end());
    for (oracles::FractionRow& row : minor) row.erase(row.begin() + static_cast<std::ptrdiff_t>(j));
    sum += (j % 2 == 0 ? 1 : -1) * rows.front()[j] * determinant(minor);
  }
  return sum;
}

/// Rows of many kinds: short, long, of doubles, nearly dependent by one unit in a huge entry, dependent.
IntegerRows sample(unsigned seed, std::size_t r) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const int kind = static_cast<int>(seed % 5);
  IntegerRows rows;
  for (std::size_t i = 0; i < r; ++i) {
    convex::Vector x(static_cast<convex::Index>(r));
    for (double& entry : x)
      entry = kind == 0   ? std::uniform_int_distribution<int>(-1, 1)(random)
              : kind == 1 ? std::round(1e6 * normal(random))
                          : std::ldexp(normal(random), kind == 2 ? 0 : 40 * static_cast<int>(i));
    rows.push_back(convex::exact_vector(x).numerators);
  }
  if (kind >= 3 && r > 1) {  // the last row: the sum of the others
    for (std::size_t j = 0; j < r; ++j) {
      rows[r - 1][j] = 0;
      for (std::size_t i = 0; i + 1 < r; ++i) rows[r - 1][j] += rows[i][j];
    }
    if (kind == 4) rows[r - 1][0] += 1;
  }
  return rows;
}

}  // namespace

TEST_CASE(
    "the sign of a determinant is that of Laplace's expansion, for ties and for numbers of any length") {
  int zeros = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::size_t r = 1 + seed % 6;
    const IntegerRows rows = sample(seed, r);
    const convex::DeterminantSign sign(rows, r);
    std::vector<std::size_t> chosen(r);
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    std::shuffle(chosen.begin(), chosen.end(), std::mt19937(seed));
    std::vector<oracles::FractionRow> fractions;
    for (std::size_t k : chosen) fractions.push_back(oracles::fractions(rows[k]));
    const int expected = sgn(determinant(fractions));
    CAPTURE(seed);
    CHECK(sign(chosen) == expected);
    zeros += expected == 0;
  }
  CHECK(zeros > 20);
}
