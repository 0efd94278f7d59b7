#include "convex/exact/minors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace convex {
namespace {

__extension__ using Wide = __int128;

template <class Word>
bool vanishes(Word a) {
  return a == 0;
}
bool vanishes(const Integer& a) { return a.is_zero(); }
template <class Word>
Word quotient(Word a, Word b) {
  return a / b;
}
Integer quotient(const Integer& a, const Integer& b) { return exact_quotient(a, b); }

/// Fraction-free elimination (Bareiss 1968) with exchanges of columns, then back substitution by Cramer's
/// rule: every number is a minor. `a`: r - 1 rows of r entries, row by row.
template <class Number>
std::vector<Number> normal_of(std::vector<Number> a, std::size_t r) {
  const std::size_t rows = r - 1;
  std::vector<std::size_t> column(r);
  std::iota(column.begin(), column.end(), std::size_t{0});
  const auto at = [&](std::size_t i, std::size_t j) -> Number& { return a[i * r + column[j]]; };
  Number previous = 1;
  for (std::size_t k = 0; k < rows; ++k) {
    std::size_t pivot = k;
    while (pivot < r && vanishes(at(k, pivot))) ++pivot;
    if (pivot == r) return {};
    std::swap(column[k], column[pivot]);
    for (std::size_t i = k + 1; i < rows; ++i)
      for (std::size_t j = k + 1; j < r; ++j)
        at(i, j) = quotient(at(k, k) * at(i, j) - at(i, k) * at(k, j), previous);
    previous = at(k, k);
  }
  std::vector<Number> normal(r, Number(0));
  normal[column[r - 1]] = previous;
  for (std::size_t k = rows; k-- > 0;) {
    Number sum = 0;
    for (std::size_t j = k + 1; j < r; ++j) sum += at(k, j) * normal[column[j]];
    normal[column[k]] = quotient(-sum, at(k, k));
  }
  return normal;
}

/// Hadamard's bound on the minors of the rows, in bits; infinite when an entry is longer than a word.
double minor_bits(const std::vector<const IntegerVector*>& rows) {
  double bits = 0;
  for (const IntegerVector* row : rows) {
    double squared = 0;
    for (const Integer& entry : *row) {
      if (!entry.fits_word()) return std::numeric_limits<double>::infinity();
      squared += static_cast<double>(entry.word()) * static_cast<double>(entry.word());
    }
    bits += 0.5 * std::log2(std::max(1.0, squared));
  }
  return bits;
}

/// How long minors may be so that a word of so many bits holds any sum of r products of two; a little less,
/// for the rounding of the bound, and so that the minors themselves fit 64 bits.
double most_bits(double word, std::size_t r) {
  return std::min(0.5 * (word - std::log2(static_cast<double>(r + 1))) - 0.5, 62.0);
}

template <class Word>
IntegerVector normal_in_words(const std::vector<const IntegerVector*>& rows, std::size_t r) {
  std::vector<Word> a;
  a.reserve(rows.size() * r);
  for (const IntegerVector* row : rows)
    for (const Integer& entry : *row) a.push_back(entry.word());
  IntegerVector normal;
  for (Word entry : normal_of(std::move(a), r)) normal.emplace_back(static_cast<std::int64_t>(entry));
  return normal;
}

}  // namespace

IntegerVector normal_by_minors(const std::vector<const IntegerVector*>& rows, std::size_t r) {
  const double bits = minor_bits(rows);
  if (bits < most_bits(63, r)) return normal_in_words<std::int64_t>(rows, r);
  if (bits < most_bits(127, r)) return normal_in_words<Wide>(rows, r);
  std::vector<Integer> a;
  a.reserve(rows.size() * r);
  for (const IntegerVector* row : rows) a.insert(a.end(), row->begin(), row->end());
  return normal_of(std::move(a), r);
}

}  // namespace convex
