#include "convex/exact/determinant_sign.hpp"

#include <array>
#include <cmath>

#include "convex/exact/fraction_free.hpp"

namespace convex::inline exact_arithmetic {
namespace {

/// The factorisation in doubles is done in place on the stack; larger matrices go without it.
constexpr std::size_t largest_filtered = 12;

template <class Number>
int sign_of(std::vector<Number> a, std::size_t r) {
  const Eliminated<Number> e = eliminate(std::move(a), r, r);
  if (!e.independent) return 0;
  const bool negative = e.last < Number(0);
  return negative != e.odd_exchanges ? -1 : 1;
}

template <class Word>
int sign_in_words(const IntegerRows& rows, const std::vector<std::size_t>& chosen) {
  std::vector<Word> a;
  a.reserve(chosen.size() * chosen.size());
  for (std::size_t row : chosen)
    for (const Integer& entry : rows[row]) a.push_back(entry.word());
  return sign_of(std::move(a), chosen.size());
}

}  // namespace

DeterminantSign::DeterminantSign(const IntegerRows& rows, std::size_t r)
    : rows_(rows), r_(r), rounded_(static_cast<Index>(rows.size()), static_cast<Index>(r)) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Integer largest = 1;
    for (const Integer& entry : rows[k]) largest = std::max(largest, entry.sign() < 0 ? -entry : entry);
    for (std::size_t i = 0; i < r; ++i)
      rounded_(static_cast<Index>(k), static_cast<Index>(i)) = nearest_quotient(rows[k][i], largest);
    bits_.push_back(norm_bits(rows[k]));
  }
  lengths_ = rounded_.rowwise().norm();
}

int DeterminantSign::operator()(const std::vector<std::size_t>& chosen) const {
  const int sign = by_doubles(chosen);
  return sign != 0 ? sign : exactly(chosen);
}

/// LU with exchanges of rows: the factors are those of A + E, |E| <= gamma_r |L||U| (Higham 2002, theorem
/// 9.3), and |L| <= 1, so that with g the largest |u| each entry of E, that of rounding the data included, is
/// below (r² g + 1) 1.1 u. A determinant is linear in each row and bounded by the product of their lengths,
/// each at least 1 here: it moves by less than that product times ((1 + e)^r - 1), e the length of a row of
/// E. 0 when that leaves the sign open.
int DeterminantSign::by_doubles(const std::vector<std::size_t>& chosen) const {
  if (r_ > largest_filtered) return 0;
  std::array<double, largest_filtered * largest_filtered> a;
  double lengths = 1;
  for (std::size_t i = 0; i < r_; ++i) {
    const auto row = static_cast<Index>(chosen[i]);
    for (std::size_t j = 0; j < r_; ++j) a[i * r_ + j] = rounded_(row, static_cast<Index>(j));
    lengths *= lengths_[row];
  }
  double determinant = 1, largest = 1;
  for (std::size_t k = 0; k < r_; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < r_; ++i)
      if (std::abs(a[i * r_ + k]) > std::abs(a[pivot * r_ + k])) pivot = i;
    if (pivot != k) {
      for (std::size_t j = k; j < r_; ++j) std::swap(a[k * r_ + j], a[pivot * r_ + j]);
      determinant = -determinant;
    }
    const double head = a[k * r_ + k];
    determinant *= head;
    if (!(std::abs(head) > 0)) return 0;
    for (std::size_t i = k + 1; i < r_; ++i) {
      const double factor = a[i * r_ + k] / head;
      for (std::size_t j = k + 1; j < r_; ++j) {
        a[i * r_ + j] -= factor * a[k * r_ + j];
        largest = std::max(largest, std::abs(a[i * r_ + j]));
      }
    }
  }
  // Twice the bound: for 1.1, for (1 + e)^r - 1 over r e, and for the roundings of the product of pivots.
  const auto r = static_cast<double>(r_);
  const double slack = 2 * lengths * r * std::sqrt(r) * (r * r * largest + 1) * unit_roundoff +
                       4 * r * unit_roundoff * std::abs(determinant);
  return determinant > slack ? 1 : determinant < -slack ? -1 : 0;
}

int DeterminantSign::exactly(const std::vector<std::size_t>& chosen) const {
  double bits = 0;
  for (std::size_t row : chosen) bits += bits_[row];
  if (bits < most_minor_bits(word_bits, r_)) return sign_in_words<std::int64_t>(rows_, chosen);
  if (bits < most_minor_bits(double_word_bits, r_)) return sign_in_words<DoubleWord>(rows_, chosen);
  std::vector<Integer> a;
  for (std::size_t row : chosen) a.insert(a.end(), rows_[row].begin(), rows_[row].end());
  return sign_of(std::move(a), r_);
}

}  // namespace convex::inline exact_arithmetic
