#include "convex/exact/elimination.hpp"

#include <gmp.h>

#include <algorithm>
#include <cmath>

#include "convex/exact/fraction.hpp"
#include "convex/exact/minors.hpp"

namespace convex::inline exact_arithmetic {
namespace {

__extension__ using TwoWords = __int128;

Integer of_two_words(TwoWords x) {
  constexpr int half = 32;  // so that the lower half is a word with a sign
  const auto word = static_cast<std::int64_t>(x);
  if (word == x) return word;
  const auto low = static_cast<std::int64_t>(x & 0xffffffff);
  return Integer::shifted(static_cast<std::int64_t>(x >> half >> half), 2 * half) +
         Integer::shifted(static_cast<std::int64_t>((x >> half) & 0xffffffff), half) + low;
}

/// v times a positive number minus a multiple of the row, 0 at its pivot.
void clear_pivot(IntegerVector& v, const IntegerVector& row, std::size_t pivot) {
  if (v[pivot].is_zero()) return;
  const Integer common = greatest_common_divisor(v[pivot], row[pivot]);
  const Integer factor = exact_quotient(v[pivot], common), own = exact_quotient(row[pivot], common);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = own * v[i] - factor * row[i];
}

}  // namespace

Integer dot(const IntegerVector& a, const IntegerVector& b) {
  TwoWords words_sum = 0;  // of products of words, as long as it fits
  std::size_t i = 0;
  for (; i < a.size() && a[i].fits_word() && b[i].fits_word(); ++i) {
    TwoWords next = 0;
    if (__builtin_add_overflow(words_sum, TwoWords{a[i].word()} * b[i].word(), &next)) break;
    words_sum = next;
  }
  Integer sum = of_two_words(words_sum);
  if (i == a.size()) return sum;
  mpz_t total, words;
  mpz_init(total);
  mpz_init(words);
  const auto add_product = [&](const Integer& x, const Integer& y) {
    if (x.is_zero() || y.is_zero()) return;
    if (!x.fits_word()) {
      mpz_addmul(total, static_cast<mpz_srcptr>(x.gmp()), static_cast<mpz_srcptr>(y.gmp()));
      return;
    }
    const auto magnitude =
        x.word() < 0 ? -static_cast<unsigned long>(x.word()) : static_cast<unsigned long>(x.word());
    if (y.fits_word()) mpz_set_si(words, y.word());
    const mpz_srcptr other = y.fits_word() ? words : static_cast<mpz_srcptr>(y.gmp());
    if (x.word() < 0)
      mpz_submul_ui(total, other, magnitude);
    else
      mpz_addmul_ui(total, other, magnitude);
  };
  if (sum.fits_word())
    mpz_set_si(total, sum.word());
  else
    mpz_set(total, static_cast<mpz_srcptr>(sum.gmp()));
  for (; i < a.size(); ++i) {
    if (a[i].fits_word())
      add_product(a[i], b[i]);
    else
      b[i].fits_word() ? add_product(b[i], a[i]) : add_product(a[i], b[i]);
  }
  sum = Integer::from_gmp(static_cast<mpz_srcptr>(total));
  mpz_clear(total);
  mpz_clear(words);
  return sum;
}

IntegerVector reduced(IntegerVector v, const Echelon& space) {
  for (std::size_t k = 0; k < space.rank(); ++k) clear_pivot(v, space.rows[k], space.pivots[k]);
  make_primitive(v);
  return v;
}

bool extend(Echelon& space, const IntegerVector& v) {
  IntegerVector rest = reduced(v, space);
  const auto leading =
      std::find_if(rest.begin(), rest.end(), [](const Integer& entry) { return !entry.is_zero(); });
  if (leading == rest.end()) return false;
  const auto pivot = static_cast<std::size_t>(leading - rest.begin());
  if (leading->sign() < 0)
    for (Integer& entry : rest) entry = -entry;
  for (IntegerVector& row : space.rows) {
    if (row[pivot].is_zero()) continue;
    clear_pivot(row, rest, pivot);
    make_primitive(row);
  }
  const auto at = std::lower_bound(space.pivots.begin(), space.pivots.end(), pivot) - space.pivots.begin();
  space.pivots.insert(space.pivots.begin() + at, pivot);
  space.rows.insert(space.rows.begin() + at, std::move(rest));
  return true;
}

Echelon echelon(const IntegerRows& rows, std::size_t columns) {
  Echelon space{columns, {}, {}};
  for (const IntegerVector& row : rows) {
    if (space.rank() == columns) break;
    extend(space, row);
  }
  return space;
}

Echelon annihilator(const Echelon& space) {
  Echelon result{space.columns, {}, {}};
  for (std::size_t f = 0; f < space.columns; ++f) {
    if (std::find(space.pivots.begin(), space.pivots.end(), f) != space.pivots.end()) continue;
    Integer multiple = 1;
    for (std::size_t k = 0; k < space.rank(); ++k) {
      const Integer& pivot = space.rows[k][space.pivots[k]];
      multiple *= exact_quotient(pivot, greatest_common_divisor(pivot, multiple));
    }
    IntegerVector a(space.columns, 0);
    a[f] = multiple;
    for (std::size_t k = 0; k < space.rank(); ++k)
      a[space.pivots[k]] = -space.rows[k][f] * exact_quotient(multiple, space.rows[k][space.pivots[k]]);
    extend(result, a);
  }
  return result;
}

IntegerVector common_normal(const std::vector<const IntegerVector*>& rows, std::size_t r) {
  IntegerVector normal = normal_by_minors(rows, r);
  make_primitive(normal);
  return normal;
}

void exchange(ExactInverse& inverse, std::size_t k, const IntegerVector& c) {
  const bool flip = c[k].sign() < 0;
  for (IntegerVector& row : inverse.adjugate) {
    for (std::size_t l = 0; l < row.size(); ++l) {
      if (l == k) continue;
      row[l] = exact_quotient(c[k] * row[l] - c[l] * row[k], inverse.determinant);
      if (flip) row[l] = -row[l];
    }
    if (flip) row[k] = -row[k];
  }
  inverse.determinant = flip ? -c[k] : c[k];
}

IntegerVector times(const IntegerVector& v, const IntegerRows& A) {
  IntegerVector product(A.empty() ? 0 : A.front().size(), 0);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i].is_zero()) continue;
    for (std::size_t j = 0; j < product.size(); ++j) product[j] += v[i] * A[i][j];
  }
  return product;
}

std::optional<ExactInverse> positive_definite_inverse(const IntegerRows& A) {
  ExactInverse inverse{IntegerRows(A.size(), IntegerVector(A.size(), 0)), 1};
  for (std::size_t i = 0; i < A.size(); ++i) inverse.adjugate[i][i] = 1;
  for (std::size_t k = 0; k < A.size(); ++k) {
    const IntegerVector c = times(A[k], inverse.adjugate);
    if (c[k].sign() <= 0) return std::nullopt;  // the leading minor of order k + 1
    exchange(inverse, k, c);
  }
  return inverse;
}

}  // namespace convex::inline exact_arithmetic
