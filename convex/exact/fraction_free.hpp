#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "convex/exact/integer.hpp"

/// Elimination without fractions in any type of integers: every number that arises is a minor (Bareiss 1968).
namespace convex::inline exact_arithmetic {

__extension__ using DoubleWord = __int128;

template <class Word>
bool vanishes(Word a) {
  return a == 0;
}
inline bool vanishes(const Integer& a) { return a.is_zero(); }

/// a / b, known to leave nothing.
template <class Word>
Word quotient(Word a, Word b) {
  return a / b;
}
inline Integer quotient(const Integer& a, const Integer& b) { return exact_quotient(a, b); }

/// rows × columns numbers, row by row, in echelon form after exchanges of columns: entry (i, j) is
/// a[i * columns + order[j]]. `last` is the last pivot, 1 without rows.
template <class Number>
struct Eliminated {
  std::vector<Number> a;
  std::vector<std::size_t> order;
  Number last = 1;
  bool independent = true;
  bool odd_exchanges = false;
};

template <class Number>
Eliminated<Number> eliminate(std::vector<Number> a, std::size_t rows, std::size_t columns) {
  Eliminated<Number> e{std::move(a), std::vector<std::size_t>(columns), 1, true, false};
  std::iota(e.order.begin(), e.order.end(), std::size_t{0});
  const auto at = [&](std::size_t i, std::size_t j) -> Number& { return e.a[i * columns + e.order[j]]; };
  for (std::size_t k = 0; k < rows; ++k) {
    std::size_t pivot = k;
    while (pivot < columns && vanishes(at(k, pivot))) ++pivot;
    if (pivot == columns) {
      e.independent = false;
      return e;
    }
    if (pivot != k) {
      std::swap(e.order[k], e.order[pivot]);
      e.odd_exchanges = !e.odd_exchanges;
    }
    for (std::size_t i = k + 1; i < rows; ++i)
      for (std::size_t j = k + 1; j < columns; ++j)
        at(i, j) = quotient(Number(at(k, k) * at(i, j) - at(i, k) * at(k, j)), e.last);
    e.last = at(k, k);
  }
  return e;
}

/// log2 of a row's Euclidean norm, at least 0; infinite when an entry is longer than a word. The sum over
/// rows bounds their minors (Hadamard 1893).
double norm_bits(const IntegerVector& row);

/// How long minors may be so that a word of so many bits holds any sum of r products of two; a little less,
/// for the rounding of the bound, and so that the minors themselves fit 64 bits.
double most_minor_bits(double word, std::size_t r);

inline constexpr double word_bits = 63, double_word_bits = 127;  ///< without the sign

}  // namespace convex::inline exact_arithmetic
