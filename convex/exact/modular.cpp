#include "convex/exact/modular.hpp"

#include <gmp.h>

#include <algorithm>
#include <utility>

namespace convex::inline exact_arithmetic {
namespace {

using Word = ModularField::Word;
using Wide = ModularField::Wide;

constexpr Word power = Word{1} << 62U;

/// row -= factor pivot_row from `first` on.
void subtract_multiple(const ModularField& field, Word factor, const Word* pivot_row, Word* row,
                       std::size_t first, std::size_t columns) {
  for (std::size_t j = first; j < columns; ++j)
    row[j] = field.minus(row[j], field.times(factor, pivot_row[j]));
}

}  // namespace

const std::vector<std::uint64_t> large_primes{power - 57, power - 87, power - 117, power - 143};

ModularField::ModularField(Word prime) : p_(prime) {
  for (int k = 0; k < 6; ++k) negative_inverse_ *= 2 - p_ * negative_inverse_;  // Newton: 1/p modulo 2^64
  negative_inverse_ = -negative_inverse_;
  one_ = static_cast<Word>((static_cast<Wide>(1) << 64U) % p_);
  square_ = static_cast<Word>(static_cast<Wide>(one_) * one_ % p_);
}

ModularField::Word ModularField::from(const Integer& a) const {
  if (a.fits_word()) {
    const std::int64_t value = a.word();
    const Word magnitude = value < 0 ? -static_cast<Word>(value) : static_cast<Word>(value);
    const Word held = from_word(magnitude);
    return value < 0 ? minus(0, held) : held;
  }
  return from_word(mpz_fdiv_ui(static_cast<mpz_srcptr>(a.gmp()), p_));
}

ModularField::Word ModularField::inverse(Word a) const {
  Word result = one_;
  for (Word exponent = p_ - 2; exponent > 0; exponent >>= 1U) {  // Fermat
    if ((exponent & 1U) != 0) result = times(result, a);
    a = times(a, a);
  }
  return result;
}

std::vector<std::size_t> independent_rows(const IntegerRows& rows, std::size_t columns) {
  const ModularField field(large_primes.front());
  std::vector<std::size_t> chosen, pivots;
  std::vector<std::vector<Word>> reduced;  // 1 at the pivot
  for (std::size_t k = 0; k < rows.size() && chosen.size() < columns; ++k) {
    std::vector<Word> row(columns);
    for (std::size_t j = 0; j < columns; ++j) row[j] = field.from(rows[k][j]);
    for (std::size_t i = 0; i < reduced.size(); ++i)
      if (const Word factor = row[pivots[i]]; factor != 0)
        subtract_multiple(field, factor, reduced[i].data(), row.data(), 0, columns);
    const auto leading = std::find_if(row.begin(), row.end(), [](Word entry) { return entry != 0; });
    if (leading == row.end()) continue;
    const Word scale = field.inverse(*leading);
    pivots.push_back(static_cast<std::size_t>(leading - row.begin()));
    for (Word& entry : row) entry = field.times(entry, scale);
    reduced.push_back(std::move(row));
    chosen.push_back(k);
  }
  return chosen;
}

std::optional<std::vector<std::uint64_t>> modular_inverse(const IntegerRows& M, const ModularField& field) {
  const std::size_t n = M.size(), width = 2 * n;
  std::vector<Word> work(n * width, 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) work[i * width + j] = field.from(M[i][j]);
    work[i * width + n + i] = field.one();
  }
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    while (pivot < n && work[pivot * width + k] == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    Word* row = &work[k * width];
    if (pivot != k) std::swap_ranges(row, row + width, &work[pivot * width]);
    const Word scale = field.inverse(row[k]);
    for (std::size_t j = k; j < width; ++j) row[j] = field.times(row[j], scale);
    for (std::size_t i = 0; i < n; ++i)
      if (const Word factor = work[i * width + k]; i != k && factor != 0)
        subtract_multiple(field, factor, row, &work[i * width], k, width);
  }
  std::vector<Word> inverse(n * n);
  for (std::size_t i = 0; i < n; ++i) std::copy_n(&work[i * width + n], n, &inverse[i * n]);
  return inverse;
}

}  // namespace convex::inline exact_arithmetic
