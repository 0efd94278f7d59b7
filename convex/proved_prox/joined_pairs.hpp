#pragma once

#include <utility>

#include "convex/proved_prox/ball_numbers.hpp"
#include "convex/proved_prox/pair_of_call.hpp"

namespace convex::inline proved_prox {

/// Entries first … first + n - 1.
inline Fractions part_of(const Fractions& x, std::size_t first, std::size_t n) {
  const auto begin = x.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(n)};
}

/// Puts the pairs of blocks behind each other; `search` finds that of block k, entries first … first + n - 1.
template <class Search>
PairSearch joined(const std::vector<std::size_t>& sizes, const Search& search) {
  ProofPair whole;
  whole.is_rational = true;
  std::size_t first = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    PairSearch part = search(k, first, sizes[k]);
    if (!part.pair) return part;
    whole.x.insert(whole.x.end(), part.pair->x.begin(), part.pair->x.end());
    whole.v.insert(whole.v.end(), part.pair->v.begin(), part.pair->v.end());
    whole.f_x = whole.f_x + part.pair->f_x;
    whole.f_v = whole.f_v + part.pair->f_v;
    whole.is_rational = whole.is_rational && part.pair->is_rational;
    first += sizes[k];
  }
  return {std::move(whole), {}};
}

}  // namespace convex::inline proved_prox
