#pragma once

#include <optional>

#include "convex/functions/decomposition.hpp"
#include "convex/proved_prox/proved_split.hpp"

namespace convex::inline proved_prox {

/// A question in doubles: z and W are meant to some error, which is 0 where the doubles themselves are.
struct RoundedQuestion {
  const Call& f;
  const Vector& z;
  Vector z_radius;  ///< n
  const Metric& W;
  double W_error = 0;  ///< relative, of every entry
};

/// The proof of `proved_split.hpp`, made in doubles with bounds on every rounding: level `enclosure`. None
/// where a function has no formula in doubles, or the pairs are not near enough for ten digits.
std::optional<ProvedSplit> proof_in_doubles(const RoundedQuestion&, const Decomposition& split);

}  // namespace convex::inline proved_prox
