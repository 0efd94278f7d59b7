#pragma once

#include <cstddef>
#include <vector>

namespace mechanics::inline motions {

/// Eight numbers that are worked on at a time.
struct alignas(64) Eight {
  static constexpr std::size_t count = 8;
  double of[count] = {};
};

/// The same as one operand of arithmetic, lane by lane; for the inside of a loop, not for parameters.
using Wide [[gnu::vector_size(sizeof(Eight)), gnu::may_alias]] = double;

inline Wide* wide(Eight* x) { return reinterpret_cast<Wide*>(x); }
inline Wide* wide(std::vector<Eight>& x) { return wide(x.data()); }

constexpr std::size_t blocks_of(std::size_t numbers) { return (numbers + Eight::count - 1) / Eight::count; }

}  // namespace mechanics::inline motions
