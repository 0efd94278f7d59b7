#pragma once

#include "convex/exact_program/exact_gram.hpp"

namespace convex::inline proved_prox {

/// A metric in fractions with what bounds its norms from above, in doubles rounded up. The bound is infinite
/// where W is not proved positive definite.
class ProvedMetric {
 public:
  explicit ProvedMetric(ExactGram W);

  const ExactGram& gram() const { return W_; }
  const Metric& in_doubles() const { return doubles_; }
  /// At least ||x||_W.
  double norm_above(const Fractions& x) const;
  /// At least ||c||_(W⁻¹): from W⁻¹c in fractions where `is_exact`; else ||c|| <= ||e||_W + |c - We|₂/sqrt(α)
  /// for e near W⁻¹c in doubles and a proved α < λ_min(W).
  double dual_norm_above(const Fractions& c) const;
  bool is_proved_definite() const { return is_exact_ ? positive_ : least_ > 0; }
  /// W diagonal, or quick to solve with: everything is in fractions but the last root.
  bool is_exact() const { return is_exact_; }
  /// W⁻¹c; c: n. Where `is_exact` and definite.
  Fractions solve(const Fractions& c) const;

 private:
  ExactGram W_;
  Metric doubles_;
  bool is_exact_, positive_ = false;
  double least_ = 0;  ///< below λ_min(W), where not exact
};

/// That W is positive definite, decided in integers whatever its size.
bool is_proved_in_integers(const ExactGram& W);

/// x rounded, and the fractions of doubles.
Vector nearest(const Fractions& x);
Fractions fractions(const Vector& x);
Fractions difference(const Fractions& a, const Fractions& b);

}  // namespace convex::inline proved_prox
