#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "convex/exact/integer.hpp"

/// Linear algebra modulo a prime: what is independent or regular there is so over the rationals too, not the
/// other way round.
namespace convex::inline exact_arithmetic {

/// Numbers modulo an odd prime below 2^62, held as a 2^64 (Montgomery 1985).
class ModularField {
 public:
  using Word = std::uint64_t;
  __extension__ using Wide = unsigned __int128;

  explicit ModularField(Word prime);

  Word prime() const { return p_; }
  Word one() const { return one_; }
  /// The number as the field holds it, and back.
  Word from(const Integer& a) const;
  Word from_word(Word a) const { return reduce(static_cast<Wide>(a % p_) * square_); }
  Word plain(Word a) const { return reduce(a); }

  Word times(Word a, Word b) const { return reduce(static_cast<Wide>(a) * b); }
  Word minus(Word a, Word b) const { return a >= b ? a - b : a + p_ - b; }
  Word inverse(Word a) const;

  /// t / 2^64 for t < 2^64 p.
  Word reduce(Wide t) const {
    const Word m = static_cast<Word>(t) * negative_inverse_;
    const Word high = static_cast<Word>((t + static_cast<Wide>(m) * p_) >> 64U);
    return high >= p_ ? high - p_ : high;
  }
  /// sum + a b, kept below 2^64 p.
  Wide accumulate(Wide sum, Word a, Word b) const {
    sum += static_cast<Wide>(a) * b;
    const Wide limit = static_cast<Wide>(p_) << 64U;
    return sum >= limit ? sum - limit : sum;
  }

 private:
  Word p_, negative_inverse_ = 1, square_ = 0, one_ = 0;
};

/// Primes to try one after the other.
extern const std::vector<std::uint64_t> large_primes;

/// Rows that are independent modulo a prime, hence over the rationals, each taken where it adds to those
/// before it. Presumably all there are; that is for the caller to prove.
std::vector<std::size_t> independent_rows(const IntegerRows& rows, std::size_t columns);

/// M⁻¹ modulo a prime, row by row, entries as the field holds them; none when M is singular there.
std::optional<std::vector<std::uint64_t>> modular_inverse(const IntegerRows& M, const ModularField& field);

/// The inverse of M with one more row and column, [M column; row corner], from M⁻¹ (n×n); none where that is
/// singular modulo the prime. Entries as the field holds them.
std::optional<std::vector<std::uint64_t>> bordered_inverse(const std::vector<std::uint64_t>& inverse,
                                                           const std::vector<std::uint64_t>& column,
                                                           const std::vector<std::uint64_t>& row,
                                                           std::uint64_t corner, const ModularField& field);

/// The inverse of M without its row and column k, from M⁻¹ (n×n); none where that is singular modulo the
/// prime.
std::optional<std::vector<std::uint64_t>> inverse_without(const std::vector<std::uint64_t>& inverse,
                                                          std::size_t n, std::size_t k,
                                                          const ModularField& field);

}  // namespace convex::inline exact_arithmetic
