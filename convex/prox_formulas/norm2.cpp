#include "convex/prox_formulas/norm2.hpp"

#include <cmath>
#include <string>

#include "convex/invalid_input.hpp"

namespace convex::prox_formulas {

namespace {

void require_not_negative(double size, const char* name) {
  if (!(size >= 0))
    throw InvalidInput(std::string(name) + " is " + std::to_string(size) +
                       "; give a number that is not negative");
}

}  // namespace

double length(const Eigen::Ref<const Vector>& z) {
  const double square = z.squaredNorm();
  // Squares are exact to rounding unless some that count left the range of doubles.
  if (square > 0x1p-900 && square < 0x1p1000) return std::sqrt(square);
  const double largest = z.size() > 0 ? z.cwiseAbs().maxCoeff() : 0;
  if (!(largest > 0)) return 0;
  const int k = std::ilogb(largest);
  return std::ldexp(z.unaryExpr([k](double v) { return std::ldexp(v, -k); }).norm(), k);
}

Vector rescaled(const Eigen::Ref<const Vector>& z, double norm, double wanted) {
  const double factor = wanted / norm;
  if (factor > 0x1p-1000 && factor < 0x1p1000) return factor * z;  // a normal number carries all digits
  return (z / norm) * wanted;
}

Vector proj_ball2(const Vector& z, double radius) {
  require_not_negative(radius, "ball2: the radius");
  const double norm = length(z);
  if (norm <= radius) return z;
  return rescaled(z, norm, radius);
}

Vector prox_norm2(const Vector& z, double weight) {
  require_not_negative(weight, "norm2: the weight");
  const double norm = length(z);
  if (norm <= weight) return Vector::Zero(z.size());
  return rescaled(z, norm, norm - weight);
}

}  // namespace convex::prox_formulas
