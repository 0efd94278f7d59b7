#include "convex/exact/minors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace convex {
namespace {

__extension__ using Wide = __int128;

bool vanishes(Wide a) { return a == 0; }
bool vanishes(const Integer& a) { return a.is_zero(); }
Wide quotient(Wide a, Wide b) { return a / b; }
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

}  // namespace

bool minors_fit_words(const std::vector<const IntegerVector*>& rows) {
  constexpr double most_bits = 60, most_entries = 64;
  double bits = 0;
  for (const IntegerVector* row : rows) {
    double squared = 0;
    for (const Integer& entry : *row) {
      if (!entry.fits_word()) return false;
      squared += static_cast<double>(entry.word()) * static_cast<double>(entry.word());
    }
    bits += 0.5 * std::log2(std::max(1.0, squared));
    if (static_cast<double>(row->size()) > most_entries) return false;
  }
  return bits < most_bits;
}

IntegerVector normal_in_words(const std::vector<const IntegerVector*>& rows, std::size_t r) {
  std::vector<Wide> a;
  a.reserve(rows.size() * r);
  for (const IntegerVector* row : rows)
    for (const Integer& entry : *row) a.push_back(entry.word());
  IntegerVector normal;
  for (Wide entry : normal_of(std::move(a), r)) normal.emplace_back(static_cast<std::int64_t>(entry));
  return normal;
}

IntegerVector normal_in_integers(const std::vector<const IntegerVector*>& rows, std::size_t r) {
  std::vector<Integer> a;
  a.reserve(rows.size() * r);
  for (const IntegerVector* row : rows) a.insert(a.end(), row->begin(), row->end());
  return normal_of(std::move(a), r);
}

}  // namespace convex
