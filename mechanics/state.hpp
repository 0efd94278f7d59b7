#pragma once

#include "convex/vector.hpp"

namespace mechanics {

using convex::Index;
using convex::Vector;

/// The state of a system at an instant: t, the coordinates q and the velocities v = q' (both of size n).
struct State {
  double t = 0;
  Vector q;
  Vector v;
};

}  // namespace mechanics
