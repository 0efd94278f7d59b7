#pragma once

#include <random>

#include "convex/vector.hpp"

namespace convex::inline families {

/// Seeded integers, the same on every machine (the standard's distributions are not).
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : generator_(seed) {}
  /// An integer of low..high.
  double integer(int low, int high) {
    return static_cast<double>(low +
                               static_cast<int>(generator_() % static_cast<std::uint32_t>(high - low + 1)));
  }
  /// One of 0..below-1, below < 2³².
  Index index(Index below) { return static_cast<Index>(generator_() % static_cast<std::uint32_t>(below)); }
  Vector integers(Index n, int low, int high) {
    Vector x(n);
    for (Index i = 0; i < n; ++i) x[i] = integer(low, high);
    return x;
  }

 private:
  std::mt19937 generator_;
};

}  // namespace convex::inline families
