#pragma once

#include "convex/exact_program/exact_gram.hpp"
#include "convex/gamma0/call.hpp"
#include "convex/proved_prox/proof_pair.hpp"
#include "convex/symbolic/surd.hpp"

namespace convex::inline sets::subgradients {

/// f(x): +inf, a fraction or a + b sqrt(c) where it is known to be one, and else what holds it.
struct KnownValue {
  bool is_infinite = false;
  std::optional<symbolic::Surd> exact = {};
  std::optional<FractionInterval> between = {};
};

KnownValue known_value(const Call& f, const ExactGram& W, const Fractions& x);

/// The sign of a - b, both finite; none where neither exact values nor what holds them tell.
std::optional<int> order(const KnownValue& a, const KnownValue& b);

}  // namespace convex::inline sets::subgradients
