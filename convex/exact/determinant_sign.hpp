#pragma once

#include "convex/exact/integer.hpp"
#include "convex/vector.hpp"

namespace convex::inline exact_arithmetic {

/// Signs of determinants of r of the rows, of r entries each, always exact: by an LU factorisation in doubles
/// where its error bound leaves no doubt, else without fractions in words of 64 or 128 bits where Hadamard's
/// bound shows that they suffice, else in integers of any size.
class DeterminantSign {
 public:
  DeterminantSign(const IntegerRows& rows, std::size_t r);
  /// -1, 0 or 1, for the r rows chosen in this order.
  int operator()(const std::vector<std::size_t>& chosen) const;

 private:
  int by_doubles(const std::vector<std::size_t>& chosen) const;
  int exactly(const std::vector<std::size_t>& chosen) const;

  const IntegerRows& rows_;
  std::size_t r_;
  RowMatrix rounded_;         ///< each row over its largest entry
  Vector lengths_;            ///< of the rounded rows, between 1 and sqrt(r)
  std::vector<double> bits_;  ///< norm_bits of the rows
};

}  // namespace convex::inline exact_arithmetic
