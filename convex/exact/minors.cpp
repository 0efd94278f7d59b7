#include "convex/exact/minors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/exact/fraction_free.hpp"

namespace convex::inline exact_arithmetic {
namespace {

/// Back substitution by Cramer's rule, so that every number is a minor again.
template <class Number>
std::vector<Number> normal_of(std::vector<Number> a, std::size_t r) {
  const std::size_t rows = r - 1;
  const Eliminated<Number> e = eliminate(std::move(a), rows, r);
  if (!e.independent) return {};
  const auto at = [&](std::size_t i, std::size_t j) -> const Number& { return e.a[i * r + e.order[j]]; };
  std::vector<Number> normal(r, Number(0));
  normal[e.order[rows]] = e.last;
  for (std::size_t k = rows; k-- > 0;) {
    Number sum = 0;
    for (std::size_t j = k + 1; j < r; ++j) sum += at(k, j) * normal[e.order[j]];
    normal[e.order[k]] = quotient(Number(-sum), at(k, k));
  }
  return normal;
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

double norm_bits(const IntegerVector& row) {
  double squared = 0;
  for (const Integer& entry : row) {
    if (!entry.fits_word()) return std::numeric_limits<double>::infinity();
    squared += static_cast<double>(entry.word()) * static_cast<double>(entry.word());
  }
  return 0.5 * std::log2(std::max(1.0, squared));
}

double most_minor_bits(double word, std::size_t r) {
  constexpr double margin = 0.5, longest = 62;
  return std::min(0.5 * (word - std::log2(static_cast<double>(r + 1))) - margin, longest);
}

IntegerVector normal_by_minors(const std::vector<const IntegerVector*>& rows, std::size_t r) {
  double bits = 0;
  for (const IntegerVector* row : rows) bits += norm_bits(*row);
  if (bits < most_minor_bits(word_bits, r)) return normal_in_words<std::int64_t>(rows, r);
  if (bits < most_minor_bits(double_word_bits, r)) return normal_in_words<DoubleWord>(rows, r);
  std::vector<Integer> a;
  a.reserve(rows.size() * r);
  for (const IntegerVector* row : rows) a.insert(a.end(), row->begin(), row->end());
  return normal_of(std::move(a), r);
}

}  // namespace convex::inline exact_arithmetic
