#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::inline operations {

/// A sum of vectors, as of nested translations: rounded once, however many there are and whatever cancels
/// between them. The terms are kept where their sum is no vector of doubles.
class MergedVector {
 public:
  MergedVector(Vector v) : terms_{v}, value_(std::move(v)), rest_(Vector::Zero(value_.size())) {}  // NOLINT

  MergedVector plus(const Vector& v) const;
  const Vector& value() const { return value_; }
  /// The sum less `value`, rounded.
  const Vector& rest() const { return rest_; }
  /// One where `value` is the sum itself.
  const std::vector<Vector>& terms() const { return terms_; }

 private:
  std::vector<Vector> terms_;
  Vector value_, rest_;
};

}  // namespace convex::inline operations
