#include "convex/prox_formulas/second_order_cone.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/norm2.hpp"

namespace convex::prox_formulas {

namespace {

constexpr double root_half = std::numbers::sqrt2 / 2;

void require_size(const Vector& z, Index least, const char* cone) {
  if (z.size() < least)
    throw InvalidInput(std::string(cone) + ": the point has " + counted(z.size(), "entry", "entries") +
                       "; give at least " + std::to_string(least));
}

/// The rotation that takes the rotated cone to the plain one: (v, (a - b)/√2, (a + b)/√2).
Vector rotated(const Vector& z) {
  const Index n = z.size();
  Vector plain = z;
  const double a = z[n - 2] * root_half, b = z[n - 1] * root_half;
  plain[n - 2] = a - b;
  plain[n - 1] = a + b;
  return plain;
}

bool in_rotated(double v, double a, double b) {
  return a >= 0 && b >= 0 && v <= std::numbers::sqrt2 * std::sqrt(a) * std::sqrt(b);
}

/// Nearest point of the rotated cone (side = 1) or of its opposite, which is its polar (side = -1).
Vector proj_rotated(const Vector& z, double side) {
  const Index n = z.size();
  require_size(z, 2, "rotated_second_order_cone");
  const double v = length(z.head(n - 2)), a = side * z[n - 2], b = side * z[n - 1];
  if (in_rotated(v, a, b)) return z;
  if (in_rotated(v, -a, -b)) return Vector::Zero(n);
  const double apart = a * root_half - b * root_half, up = a * root_half + b * root_half;
  const double across = std::hypot(v, apart), shrink = (across / 2 + up / 2) / across;
  // across - |apart| without cancellation: the smaller of a and b keeps its digits.
  const double near = v * (v / (across + std::abs(apart))), far = across + std::abs(apart);
  Vector x(n);
  x.head(n - 2) = shrink * z.head(n - 2);
  x[n - 2] = side * shrink * root_half * (apart > 0 ? far : near);
  x[n - 1] = side * shrink * root_half * (apart > 0 ? near : far);
  return x;
}

/// Nearest point of {|v| <= side t}, side = ±1.
Vector proj_cone(const Vector& z, double side) {
  require_size(z, 1, "second_order_cone");
  const Index m = z.size() - 1;
  const double v = length(z.head(m)), t = side * z[m];
  if (v <= t) return z;
  if (v <= -t) return Vector::Zero(m + 1);
  const double half = v / 2 + t / 2;
  Vector x(m + 1);
  x.head(m) = rescaled(z.head(m), v, half);
  x[m] = side * half;
  return x;
}

}  // namespace

Vector proj_second_order_cone(const Vector& z) { return proj_cone(z, 1); }
Vector proj_second_order_polar(const Vector& z) { return proj_cone(z, -1); }

Matrix proj_second_order_cone_jacobian(const Vector& z) {
  require_size(z, 1, "second_order_cone");
  const Index m = z.size() - 1;
  const double v = length(z.head(m)), t = z[m];
  if (v <= t) return Matrix::Identity(m + 1, m + 1);
  if (v <= -t) return Matrix::Zero(m + 1, m + 1);
  const Vector e = z.head(m) / v;
  const double r = t / v;
  Matrix J(m + 1, m + 1);
  J.topLeftCorner(m, m) = (1 + r) * Matrix::Identity(m, m) - r * e * e.transpose();
  J.topRightCorner(m, 1) = e;
  J.bottomLeftCorner(1, m) = e.transpose();
  J(m, m) = 1;
  return 0.5 * J;
}

Vector proj_rotated_cone(const Vector& z) { return proj_rotated(z, 1); }
Vector proj_rotated_polar(const Vector& z) { return proj_rotated(z, -1); }

Matrix proj_rotated_cone_jacobian(const Vector& z) {
  const Index n = z.size();
  require_size(z, 2, "rotated_second_order_cone");
  const double v = length(z.head(n - 2));
  if (in_rotated(v, z[n - 2], z[n - 1])) return Matrix::Identity(n, n);
  if (in_rotated(v, -z[n - 2], -z[n - 1])) return Matrix::Zero(n, n);
  Matrix rotation = Matrix::Identity(n, n);
  rotation.bottomRightCorner(2, 2) << root_half, -root_half, root_half, root_half;
  return rotation.transpose() * proj_second_order_cone_jacobian(rotated(z)) * rotation;
}

}  // namespace convex::prox_formulas
