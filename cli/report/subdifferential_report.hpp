#pragma once

#include <string>

#include "convex/sets/subdifferential.hpp"

namespace cli::inline reports {

/// A subdifferential with what was asked of it.
struct ToldSubdifferential {
  convex::Call f;
  convex::Fractions x;
  convex::Subdifferential at;
  std::string why_empty;                ///< where it is
  std::optional<convex::Vector> least;  ///< the element of least norm in the dual metric
  double least_norm = 0;
  std::optional<bool> contains;                             ///< the covector asked for
  std::optional<double> along;                              ///< f'(x; d)
  std::optional<convex::PolyhedralCone> tangent, critical;  ///< of a polyhedron's normal cone
};

std::string subdifferential_json(const ToldSubdifferential&);
std::string subdifferential_text(const ToldSubdifferential&);

}  // namespace cli::inline reports
