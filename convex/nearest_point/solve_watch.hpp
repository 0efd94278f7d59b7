#pragma once

#include <functional>
#include <string_view>

#include "convex/vector.hpp"

namespace convex {

/// Hears from solves of this thread how far they are, as long as it lives: the method and the steps it has
/// made, of interior-point, V-cycles, poolings, or rows taken in and dropped in fractions. It must not throw.
/// Large and sparse problems report, and fractions; dense ones are over before anybody could look. The answer
/// does not depend on it. Watches nest: the last one hears.
class SolveWatch {
 public:
  using Listener = std::function<void(std::string_view method, Index steps)>;
  explicit SolveWatch(Listener);
  ~SolveWatch();
  SolveWatch(const SolveWatch&) = delete;
  SolveWatch& operator=(const SolveWatch&) = delete;

  /// What a method calls after a step that takes long.
  static void tell(std::string_view method, Index steps);

 private:
  Listener listener_;
  SolveWatch* before_;
};

}  // namespace convex
