#pragma once

#include <cstdint>

#include "convex/nearest_point/problem.hpp"

/// Nearest-point problems at the edge of rounding: small whole numbers, moved by powers of two that doubles
/// hold and their products do not.
namespace fuzz {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  /// 0 … bound - 1.
  int below(int bound) { return static_cast<int>(bits() % static_cast<std::uint64_t>(bound)); }
  /// low … high.
  int between(int low, int high) { return low + below(high - low + 1); }
  bool one_in(int n) { return below(n) == 0; }
  double sign() { return one_in(2) ? 1 : -1; }
  /// ±2^-k, k up to 52, or 0 now and then.
  double tiny();

 private:
  std::uint64_t state_;
};

inline constexpr int edge_family_count = 10;
const char* edge_family(int family);
convex::NearestPointProblem draw_edge(int family, Random&);

}  // namespace fuzz
