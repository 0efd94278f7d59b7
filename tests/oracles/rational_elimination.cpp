#include "tests/oracles/rational_elimination.hpp"

namespace oracles {

std::vector<std::size_t> row_reduce(std::vector<RationalVector>& M, std::size_t columns) {
  std::vector<std::size_t> pivots;
  for (std::size_t c = 0; c < columns && pivots.size() < M.size(); ++c) {
    std::size_t row = pivots.size();
    while (row < M.size() && M[row][c] == 0) ++row;
    if (row == M.size()) continue;
    std::swap(M[row], M[pivots.size()]);
    RationalVector& pivot = M[pivots.size()];
    const Rational scale = pivot[c];
    for (Rational& entry : pivot) entry /= scale;
    for (std::size_t i = 0; i < M.size(); ++i) {
      if (i == pivots.size() || M[i][c] == 0) continue;
      const Rational factor = M[i][c];
      for (std::size_t j = c; j < pivot.size(); ++j)
        if (pivot[j] != 0) M[i][j] -= factor * pivot[j];
    }
    pivots.push_back(c);
  }
  return pivots;
}

}  // namespace oracles
