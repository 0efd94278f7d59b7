#include "convex/functions/inverse_form.hpp"

#include "convex/exact/fraction.hpp"
#include "convex/exact/fraction_arithmetic.hpp"

namespace convex::inline named_functions {
namespace {

/// A millisecond for entries of one size.
constexpr Index most_coordinates = 24;

/// v - c over one denominator.
ExactVector exact_difference(const Vector& v, const Vector& c) {
  Vector both(v.size() + c.size());
  both << v, c;
  ExactVector all = exact_vector(both);
  ExactVector difference{{}, all.denominator};
  const auto n = static_cast<std::size_t>(v.size());
  for (std::size_t i = 0; i < n; ++i)
    difference.numerators.push_back(all.numerators[i] - all.numerators[n + i]);
  return difference;
}

}  // namespace

std::optional<InverseForm> InverseForm::of(const Matrix& Q) {
  if (Q.rows() > most_coordinates) return std::nullopt;
  const IntegerMatrix form = over_one_denominator(exact_rows(Q));
  std::optional<ExactInverse> inverse = positive_definite_inverse(form.rows);
  if (!inverse) return std::nullopt;
  return InverseForm(*std::move(inverse), form.denominator);
}

double InverseForm::value(const Vector& v, const Vector& c, double constant) const {
  const ExactVector from = exact_difference(v, c);
  const Integer square = dot(from.numerators, times(from.numerators, inverse_.adjugate)) * scale_;
  const Fraction half{square, Integer(2) * inverse_.determinant * from.denominator * from.denominator};
  return nearest_double(half - fraction(constant));
}

Matrix InverseForm::matrix() const {
  const auto n = static_cast<Index>(inverse_.adjugate.size());
  Matrix made(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      made(i, j) = nearest_double(
          Fraction{inverse_.adjugate[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * scale_,
                   inverse_.determinant});
  return made;
}

}  // namespace convex::inline named_functions
