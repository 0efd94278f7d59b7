#pragma once

#include <memory>
#include <utility>
#include <vector>

class NonSmoothDynamicalSystem;

/// Siconos' event-driven scheme, in C++17: Boost's uBLAS, which it includes, is no C++20.
namespace peers {

using Times = std::vector<double>;

/// A point of mass 1.
struct SiconosScene {
  double begin, end, q, v, restitution;
  double load, shaking;                          ///< q'' = load + shaking² sin(shaking t)
  std::vector<std::pair<double, double>> walls;  ///< h and b of h q + b >= 0
};

/// The times of impacts. tolerance: absolute and relative, of LSODAR; step: of its time discretisation, where
/// it stops in any case.
Times by_siconos(const SiconosScene&, double tolerance, double step);

/// The same for the slider-crank of `slider_crank.hpp`, from its state in line.
Times slider_crank_by_siconos(double tolerance, double step);

/// What both have in common: the times of the impacts of a model that is set up.
Times times_of_impacts(const std::shared_ptr<NonSmoothDynamicalSystem>& model, double begin, double tolerance,
                       double step);

}  // namespace peers
