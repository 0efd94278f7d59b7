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

namespace {

/// Gauss-Jordan elimination in place, so many columns at a time: a sum of so many products is reduced once.
class BlockedInverse {
 public:
  BlockedInverse(const IntegerRows& M, const ModularField& field)
      : field_(field), n_(M.size()), work_(n_ * n_), order_(n_) {
    for (std::size_t i = 0; i < n_; ++i) {
      order_[i] = i;
      for (std::size_t j = 0; j < n_; ++j) work_[i * n_ + j] = field.from(M[i][j]);
    }
  }

  std::optional<std::vector<Word>> run() {
    for (std::size_t first = 0; first < n_; first += block) {
      const std::size_t count = std::min(block, n_ - first);
      if (!bring_pivots_up(first, count)) return std::nullopt;
      eliminate(first, count);
    }
    // What stands there is the inverse of the rows as they were exchanged.
    std::vector<Word> inverse(n_ * n_);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) inverse[i * n_ + order_[j]] = work_[i * n_ + j];
    return inverse;
  }

 private:
  static constexpr std::size_t block = 32;

  Word* row(std::size_t i) { return &work_[i * n_]; }

  /// Exchanges rows so that the block on the diagonal is regular, by an elimination in a copy of its columns
  /// alone. False when the columns depend on each other.
  bool bring_pivots_up(std::size_t first, std::size_t count) {
    const std::size_t rows = n_ - first;
    std::vector<Word> panel(rows * count);
    for (std::size_t i = 0; i < rows; ++i) std::copy_n(row(first + i) + first, count, &panel[i * count]);
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t pivot = k;
      while (pivot < rows && panel[pivot * count + k] == 0) ++pivot;
      if (pivot == rows) return false;
      if (pivot != k) {
        std::swap_ranges(&panel[k * count], &panel[k * count] + count, &panel[pivot * count]);
        std::swap_ranges(row(first + k), row(first + k) + n_, row(first + pivot));
        std::swap(order_[first + k], order_[first + pivot]);
      }
      const Word scale = field_.inverse(panel[k * count + k]);
      for (std::size_t i = k + 1; i < rows; ++i)
        if (const Word entry = panel[i * count + k]; entry != 0)
          subtract_multiple(field_, field_.times(entry, scale), &panel[k * count], &panel[i * count], k,
                            count);
    }
    return true;
  }

  /// With B the block on the diagonal, P its rows and F its columns: P := B⁻¹P, and B⁻¹ for B; elsewhere
  /// what stands there, or 0 in the columns of B, minus F P.
  void eliminate(std::size_t first, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      Word* const pivot_row = row(first + k);
      const Word scale = field_.inverse(pivot_row[first + k]);
      pivot_row[first + k] = field_.one();
      for (std::size_t j = 0; j < n_; ++j) pivot_row[j] = field_.times(pivot_row[j], scale);
      for (std::size_t l = 0; l < count; ++l) {
        Word* const other = row(first + l);
        const Word factor = other[first + k];
        if (l == k || factor == 0) continue;
        other[first + k] = 0;
        subtract_multiple(field_, factor, pivot_row, other, 0, n_);
      }
    }
    across_.resize(n_ * block);  // the columns of P, one after the other
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t j = 0; j < n_; ++j) across_[j * block + r] = row(first + r)[j];
    for (std::size_t i = 0; i < n_; ++i)
      if (i < first || i >= first + count) subtract_products(row(i), first, count);
  }

  void subtract_products(Word* entries, std::size_t first, std::size_t count) {
    constexpr std::size_t four = 4;  // so many products of numbers below p < 2^62 are below 2^64 p
    Word factor[block] = {};
    bool any = false;
    for (std::size_t r = 0; r < count; ++r) {
      factor[r] = std::exchange(entries[first + r], 0);
      any = any || factor[r] != 0;
    }
    if (!any) return;
    const Wide limit = static_cast<Wide>(field_.prime()) << 64U;
    for (std::size_t j = 0; j < n_; ++j) {
      const Word* const column = &across_[j * block];
      Wide sum = 0;
      for (std::size_t r = 0; r < count; r += four) {
        for (std::size_t k = r; k < r + four; ++k) sum += static_cast<Wide>(factor[k]) * column[k];
        if (sum >= limit) sum -= limit;
      }
      entries[j] = field_.minus(entries[j], field_.reduce(sum));
    }
  }

  const ModularField& field_;
  std::size_t n_;
  std::vector<Word> work_, across_;
  std::vector<std::size_t> order_;
};

}  // namespace

std::optional<std::vector<std::uint64_t>> modular_inverse(const IntegerRows& M, const ModularField& field) {
  return BlockedInverse(M, field).run();
}

std::optional<std::vector<std::uint64_t>> bordered_inverse(const std::vector<std::uint64_t>& inverse,
                                                           const std::vector<std::uint64_t>& column,
                                                           const std::vector<std::uint64_t>& row,
                                                           std::uint64_t corner, const ModularField& field) {
  const std::size_t n = column.size(), width = n + 1;
  std::vector<Word> down(n), across(n, 0);  // M⁻¹ column and row M⁻¹
  Wide along = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Wide sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum = field.accumulate(sum, inverse[i * n + j], column[j]);
    down[i] = field.reduce(sum);
    along = field.accumulate(along, row[i], down[i]);
    if (row[i] != 0)
      for (std::size_t j = 0; j < n; ++j)
        across[j] = field.minus(across[j], field.times(field.minus(0, row[i]), inverse[i * n + j]));
  }
  const Word rest = field.minus(corner, field.reduce(along));
  if (rest == 0) return std::nullopt;
  const Word scale = field.inverse(rest);
  std::vector<Word> found(width * width);
  for (std::size_t i = 0; i < n; ++i) {
    const Word part = field.minus(0, field.times(down[i], scale));
    for (std::size_t j = 0; j < n; ++j)
      found[i * width + j] = field.minus(inverse[i * n + j], field.times(part, across[j]));
    found[i * width + n] = part;
    found[n * width + i] = field.minus(0, field.times(across[i], scale));
  }
  found[n * width + n] = scale;
  return found;
}

std::optional<std::vector<std::uint64_t>> inverse_without(const std::vector<std::uint64_t>& inverse,
                                                          std::size_t n, std::size_t k,
                                                          const ModularField& field) {
  const Word pivot = inverse[k * n + k];
  if (pivot == 0) return std::nullopt;
  const Word scale = field.inverse(pivot);
  std::vector<Word> found;
  found.reserve((n - 1) * (n - 1));
  for (std::size_t i = 0; i < n; ++i) {
    if (i == k) continue;
    const Word factor = field.times(inverse[i * n + k], scale);
    for (std::size_t j = 0; j < n; ++j)
      if (j != k) found.push_back(field.minus(inverse[i * n + j], field.times(factor, inverse[k * n + j])));
  }
  return found;
}

}  // namespace convex::inline exact_arithmetic
