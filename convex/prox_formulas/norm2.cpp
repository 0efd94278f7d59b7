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

void require_groups(const Vector& z, const std::vector<Index>& sizes, const Vector& weight) {
  Index sum = 0;
  for (Index size : sizes) {
    if (size < 0) throw InvalidInput("group_norm: a group has a negative size; give sizes that sum to n");
    sum += size;
  }
  if (sum != z.size())
    throw InvalidInput("group_norm: the groups have " + std::to_string(sum) + " entries, the point " +
                       std::to_string(z.size()) + "; give sizes that sum to n");
  if (weight.size() != static_cast<Index>(sizes.size()))
    throw InvalidInput("group_norm: " + std::to_string(weight.size()) + " weights for " +
                       std::to_string(sizes.size()) + " groups; give one a group");
}

/// Calls visit(first entry, size, weight) for each group.
template <class Visit>
void for_groups(const std::vector<Index>& sizes, const Vector& weight, Visit visit) {
  Index first = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    visit(first, sizes[k], weight[static_cast<Index>(k)]);
    first += sizes[k];
  }
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

Vector proj_ball2(const Vector& z, double radius, const Vector& center) {
  require_not_negative(radius, "ball2: the radius");
  if (center.size() != z.size())
    throw InvalidInput("ball2: the center has " + std::to_string(center.size()) + " entries, the point " +
                       std::to_string(z.size()) + "; give them one size");
  const Vector v = z - center;
  const double norm = length(v);
  if (norm <= radius) return z;
  return center + rescaled(v, norm, radius);
}

Matrix proj_ball2_jacobian(const Vector& z, double radius, const Vector& center) {
  const Vector v = z - center;
  const double norm = length(v);
  Matrix J = Matrix::Identity(z.size(), z.size());
  if (norm <= radius) return J;
  const Vector direction = v / norm;
  J -= direction * direction.transpose();
  return radius / norm * J;
}

Vector prox_norm2(const Vector& z, double weight) {
  require_not_negative(weight, "norm2: the weight");
  const double norm = length(z);
  if (norm <= weight) return Vector::Zero(z.size());
  return rescaled(z, norm, norm - weight);
}

Matrix prox_norm2_jacobian(const Vector& z, double weight) {
  const double norm = length(z);
  if (!(weight > 0)) return Matrix::Identity(z.size(), z.size());
  if (norm <= weight) return Matrix::Zero(z.size(), z.size());
  const Vector direction = z / norm;
  Matrix J = (weight / norm) * direction * direction.transpose();
  J.diagonal().array() += (norm - weight) / norm;
  return J;
}

Vector prox_group_norm(const Vector& z, const std::vector<Index>& sizes, const Vector& weight) {
  require_groups(z, sizes, weight);
  Vector x(z.size());
  for_groups(sizes, weight, [&](Index first, Index size, double w) {
    x.segment(first, size) = prox_norm2(z.segment(first, size), w);
  });
  return x;
}

Matrix prox_group_norm_jacobian(const Vector& z, const std::vector<Index>& sizes, const Vector& weight) {
  require_groups(z, sizes, weight);
  Matrix J = Matrix::Zero(z.size(), z.size());
  for_groups(sizes, weight, [&](Index first, Index size, double w) {
    J.block(first, first, size, size) = prox_norm2_jacobian(z.segment(first, size), w);
  });
  return J;
}

}  // namespace convex::prox_formulas
