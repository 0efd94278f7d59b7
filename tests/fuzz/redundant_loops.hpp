#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/edge_families.hpp"

/// Linkages whose bars are written several times, in several ways, at rational and irrational angles.
namespace fuzz {

/// A problem file, and the acceleration of its mechanism: from Lagrange's equations in the angles of an
/// explicit description q(θ), which knows nothing of constraints.
struct Loop {
  std::string name, file;
  std::vector<std::string> coordinates;
  std::vector<long double> mass, acceleration;  ///< one per coordinate
  bool is_rational = false;                     ///< all numbers and functions have rational values
  bool is_contradictory = false;                ///< one bar is written twice with different d²f/dt²
};

Loop draw_loop(Random&);

}  // namespace fuzz
