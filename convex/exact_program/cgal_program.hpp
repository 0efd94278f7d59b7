#pragma once

#include "convex/exact_program/exact_minimum.hpp"

namespace convex::inline exact_programs {

/// min ½ ξ·Hξ + c·ξ over the rows by CGAL's simplex method for quadratic programs, in integers (Gärtner and
/// Schönherr 2000): ξ and the multipliers of the rows. What it says of ξ and lambda is for the caller to
/// look at; that there is no point, or no lower bound, is CGAL's word.
struct CgalAnswer {
  ProgramEnd end = ProgramEnd::minimum;
  Fractions xi, lambda;
};
CgalAnswer cgal_minimum(const ExactProgram& f);

}  // namespace convex::inline exact_programs
