#include "convex/operations/merged_vector.hpp"

#include "convex/exact/exact_sum.hpp"

namespace convex::inline operations {

MergedVector MergedVector::plus(const Vector& v) const {
  MergedVector made(*this);
  made.terms_.push_back(v);
  bool is_exact = true;
  for (Index i = 0; i < v.size(); ++i) {
    ExactSum sum;
    for (const Vector& term : made.terms_) sum.add(term[i]);
    made.value_[i] = sum.value();
    sum.add(-made.value_[i]);
    made.rest_[i] = sum.value();
    is_exact = is_exact && sum.sign() == 0;
  }
  if (is_exact) made.terms_ = {made.value_};
  return made;
}

}  // namespace convex::inline operations
