#pragma once

#include <utility>
#include <vector>

/// Siconos' event-driven scheme on a point of mass 1, in C++17: Boost's uBLAS, which it includes, is no
/// C++20.
namespace peers {

using Times = std::vector<double>;

struct SiconosScene {
  double begin, end, q, v, restitution;
  double load, shaking;                          ///< q'' = load + shaking² sin(shaking t)
  std::vector<std::pair<double, double>> walls;  ///< h and b of h q + b >= 0
};

/// The times of impacts. tolerance: absolute and relative, of LSODAR; step: of its time discretisation, where
/// it stops in any case.
Times by_siconos(const SiconosScene&, double tolerance, double step);

}  // namespace peers
