#pragma once

#include <string>

#include "convex/laws/map_potential.hpp"

namespace cli::inline reports {

/// What the test of a map came to, and the function where it was reconstructed.
struct JudgedMap {
  std::string source;  ///< the map as it was given
  bool is_table = false;
  std::pair<convex::Fraction, convex::Fraction>
      seen;  ///< the box of an expression, in one variable with its kinks
  convex::MapVerdict verdict;
  std::optional<convex::symbolic::ExactCurve> function;  ///< of one variable
  std::vector<convex::PotentialPoint> grid;
  bool is_refuted() const { return verdict.counterexample.has_value(); }
};

std::string map_json(const JudgedMap&);
std::string map_text(const JudgedMap&);
/// z, T z and f(T z), a row a point.
std::string potential_table(const JudgedMap&);

}  // namespace cli::inline reports
