#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convex/vector.hpp"

/// What `nearest_point_speed` times: planted problems, from plain ones to those that mechanics has at rest.
namespace speed {

using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

/// ½ q·Aq - z·q over Uq >= s as bare arrays.
struct DenseProblem {
  Matrix A;
  RowMatrix U;
  Vector z, s;
  Vector planted = {};  ///< the answer it was made around; empty where there is none
};

/// How problems of a family are asked: one by one, or z and s moved around the first, again and again.
enum class Asked { cold, warm };

struct Family {
  std::string name;
  Asked asked;
  bool feasible;
  Index coordinates;
  Index seeds;  ///< how many problems `make` gives: seeds 0, 1, …
  std::function<DenseProblem(unsigned seed)> make;
  bool move_bounds = false;  ///< warm: s is lowered too
};

std::vector<Family> families();

/// Eight problems with the A and U of the one given: z 1 % off, s lowered by some 1 % where `move_bounds`.
std::vector<DenseProblem> moved(const DenseProblem& problem, bool move_bounds);

}  // namespace speed
