#pragma once

#include "convex/proved_prox/proved_split.hpp"

namespace convex::inline proved_prox {

/// What is proved of a value: it lies in the interval, which may be [inf, inf]; `exact` where it is a
/// fraction.
struct ProvedValue {
  ProofLevel level = ProofLevel::none;
  ProvedInterval interval = {-INFINITY, INFINITY};
  std::optional<Fraction> exact;
  std::string why_none;

  /// The largest distance of a double from the interval's numbers; 0 of inf where the value is inf.
  double error_of(double value) const;
};

/// g(y) = sup_x (x|y) - f(x) = f*(Wy), question.z being y: in fractions where f is piecewise
/// linear-quadratic. Else between x·Wy - f(x) for a pair near Wy and f* there in balls, which enclose it
/// where a pair with the covector Wy itself is found.
ProvedValue proved_conjugate(const SplitQuestion& question);

}  // namespace convex::inline proved_prox
