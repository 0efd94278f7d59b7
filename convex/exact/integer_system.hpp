#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "convex/exact/fraction.hpp"

namespace convex::inline exact_arithmetic {

/// M x = b over the rationals for one regular integer matrix and any right sides, by lifting the solution
/// modulo a prime p to one modulo p, p², p³, … (Dixon 1982) until fractions with a common denominator can be
/// read off that satisfy every equation. A solution is returned only after M times its numerators is, in
/// integers, the denominator times b: nothing else need be trusted. The longer the fractions, the longer it
/// takes; small ones come early.
class IntegerSystem {
 public:
  /// None when M, n×n, is singular (or looks so modulo several primes of 62 bits).
  static std::optional<IntegerSystem> prepared(const IntegerRows& M);
  ExactVector solve(const IntegerVector& b) const;

  /// Makes M to [M column; row 0], or takes its row and column k away, for n² operations instead of the n³ of
  /// a new system. False, and nothing is changed, where the result is singular modulo the prime in use.
  bool append(const IntegerVector& row, const IntegerVector& column);
  bool remove(std::size_t k);

 private:
  struct Data;
  explicit IntegerSystem(std::shared_ptr<Data> data) : data_(std::move(data)) {}
  Data& own();
  std::shared_ptr<Data> data_;  ///< copies share it until one is changed
};

}  // namespace convex::inline exact_arithmetic
