#pragma once

#include <optional>

#include "convex/exact/elimination.hpp"
#include "convex/vector.hpp"

namespace convex::inline named_functions {

/// v ↦ ½ v·Q⁻¹v in fractions, for a symmetric Q that doubles do not tell from a singular one.
class InverseForm {
 public:
  /// None where Q is not positive definite, decided without rounding, or too large for that.
  static std::optional<InverseForm> of(const Matrix& Q);

  /// ½ (v - c)·Q⁻¹(v - c) - constant, rounded once.
  double value(const Vector& v, const Vector& c, double constant) const;
  /// Q⁻¹, rounded once.
  Matrix matrix() const;

 private:
  InverseForm(ExactInverse inverse, Integer scale) : inverse_(std::move(inverse)), scale_(std::move(scale)) {}
  ExactInverse inverse_;  // of scale Q
  Integer scale_;
};

}  // namespace convex::inline named_functions
