#include "convex/gamma0/value.hpp"

#include <cmath>

#include "convex/gamma0/facts.hpp"
#include "convex/infinity.hpp"
#include "convex/vector.hpp"

namespace convex::inline gamma0 {
namespace {

constexpr double roundings_of_a_sum = 4;

}  // namespace

Value sum_of_terms(double sum, double sizes) {
  return {sum, std::isfinite(sum) ? roundings_of_a_sum * unit_roundoff * sizes : 0};
}

Value indicated(double miss, double size) {
  if (!std::isfinite(miss)) return {infinity, std::isfinite(size) ? 0 : infinity};
  if (!(miss <= membership_tolerance * size)) return {infinity, 0};
  return {0, miss <= accuracy_of_prox * size ? 0 : infinity};
}

Value sum_of(const Value& a, const Value& b) {
  const double sum = a.value + b.value;
  if (std::isfinite(sum)) return {sum, a.error + b.error + unit_roundoff * std::abs(sum)};
  // What is +inf for certain stays so, whatever the other is, for none is -inf.
  const auto is_proved = [](const Value& value) { return value.value == infinity && value.error == 0; };
  if (sum == infinity && (is_proved(a) || is_proved(b))) return {infinity, 0};
  // What is finite adds nothing to what is not, nor to the doubt about it.
  return {sum, (std::isfinite(a.value) ? 0 : a.error) + (std::isfinite(b.value) ? 0 : b.error)};
}

Value multiple_of(double factor, const Value& a) {
  const double product = factor * a.value;
  return {product, factor * a.error + (std::isfinite(product) ? unit_roundoff * std::abs(product) : 0)};
}

}  // namespace convex::inline gamma0
