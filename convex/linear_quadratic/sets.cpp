#include "convex/linear_quadratic/sets.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/linear_quadratic/placement.hpp"
#include "convex/linear_quadratic/properness.hpp"

namespace convex::linear_quadratic {
namespace {

void fill(LinearQuadraticBuilder& form, const Vector& row, double sign) {
  for (Index j = 0; j < row.size(); ++j)
    if (row[j] != 0) form.entry(j, sign * row[j]);
}

void require_radius(double radius, const char* where) {
  require(radius >= 0 && std::isfinite(radius), where, "the radius is negative or not finite; give one >= 0");
}

}  // namespace

LinearQuadratic point(const Vector& p) {
  require(p.allFinite(), "point", "an entry is not finite; give numbers");
  LinearQuadraticBuilder form(p.size(), 0);
  for (Index i = 0; i < p.size(); ++i) {
    form.equation(p[i]);
    form.entry(i, 1);
  }
  return form.finish();
}

LinearQuadratic box(const Vector& lower, const Vector& upper) {
  require(lower.size() == upper.size(), "box", "the bounds differ in size; give as many of each");
  LinearQuadraticBuilder form(lower.size(), 0);
  for (Index i = 0; i < lower.size(); ++i) {
    require(lower[i] <= upper[i] && lower[i] < infinity && upper[i] > -infinity, "box",
            "a lower bound is above its upper one, infinite or not a number; the set is empty");
    if (lower[i] == upper[i]) {
      form.equation(lower[i]);
      form.entry(i, 1);
      continue;
    }
    if (lower[i] > -infinity) {
      form.row(lower[i]);
      form.entry(i, 1);
    }
    if (upper[i] < infinity) {
      form.row(-upper[i]);
      form.entry(i, -1);
    }
  }
  return form.finish();
}

LinearQuadratic orthant(Index n) { return box(Vector::Zero(n), Vector::Constant(n, infinity)); }

LinearQuadratic ball1(Index n, double radius) {
  require_radius(radius, "ball1");
  LinearQuadraticBuilder form(n, n);  // w_i >= |x_i|, their sum at most the radius
  form.row(-radius);
  for (Index i = 0; i < n; ++i) form.entry(n + i, -1);
  for (Index i = 0; i < n; ++i)
    for (double sign : {1.0, -1.0}) {
      form.row(0);
      form.entry(n + i, 1);
      form.entry(i, sign);
    }
  return form.finish();
}

LinearQuadratic ball_inf(Index n, double radius) {
  require_radius(radius, "ball_inf");
  return box(Vector::Constant(n, -radius), Vector::Constant(n, radius));
}

LinearQuadratic simplex(Index n, double total) {
  require(total >= 0 && std::isfinite(total), "simplex",
          "the total is negative or not finite; give one >= 0");
  LinearQuadraticBuilder form(n, 0);
  form.equation(total);
  for (Index i = 0; i < n; ++i) form.entry(i, 1);
  for (Index i = 0; i < n; ++i) {
    form.row(0);
    form.entry(i, 1);
  }
  return form.finish();
}

LinearQuadratic halfspace(const Vector& a, double b) {
  require(a.allFinite() && !std::isnan(b) && b > -infinity, "halfspace",
          "a or b is not a number, or b is -inf; give numbers");
  require(a.cwiseAbs().maxCoeff() > 0 || b >= 0, "halfspace", "0 <= b does not hold; the set is empty");
  LinearQuadraticBuilder form(a.size(), 0);
  if (b < infinity) {
    form.row(-b);
    fill(form, a, -1);
  }
  return form.finish();
}

LinearQuadratic hyperplane(const Vector& a, double b) {
  require(a.allFinite() && std::isfinite(b), "hyperplane", "a or b is not finite; give numbers");
  require(a.cwiseAbs().maxCoeff() > 0 || b == 0, "hyperplane", "0 = b does not hold; the set is empty");
  LinearQuadraticBuilder form(a.size(), 0);
  form.equation(b);
  fill(form, a, 1);
  return form.finish();
}

LinearQuadratic affine(const Matrix& A, const Vector& b) {
  require(A.rows() == b.size(), "affine", "A and b differ in rows; give one number for each row");
  require(A.allFinite() && b.allFinite(), "affine", "an entry is not finite; give numbers");
  LinearQuadraticBuilder form(A.cols(), 0);
  for (Index a = 0; a < A.rows(); ++a) {
    form.equation(b[a]);
    fill(form, A.row(a), 1);
  }
  LinearQuadratic set = form.finish();
  require_proper(set, "affine");
  return set;
}

LinearQuadratic polyhedron(const Matrix& A, const Vector& b) {
  require(A.rows() == b.size(), "polyhedron", "A and b differ in rows; give one number for each row");
  require(A.allFinite(), "polyhedron", "an entry of A is not finite; give numbers");
  LinearQuadraticBuilder form(A.cols(), 0);
  for (Index a = 0; a < A.rows(); ++a) {
    require(!std::isnan(b[a]) && b[a] > -infinity, "polyhedron",
            "a bound is -inf or not a number; give numbers");
    if (b[a] == infinity) continue;
    form.row(-b[a]);
    fill(form, A.row(a), -1);
  }
  LinearQuadratic set = form.finish();
  require_proper(set, "polyhedron");
  return set;
}

LinearQuadratic cone(const Matrix& generators) {
  require(generators.allFinite(), "cone", "an entry is not finite; give numbers");
  const Index n = generators.cols(), k = generators.rows();
  LinearQuadraticBuilder form(n, k);
  for (Index i = 0; i < n; ++i) {  // x = Σ w_j generator_j
    form.equation(0);
    form.entry(i, 1);
    for (Index j = 0; j < k; ++j)
      if (generators(j, i) != 0) form.entry(n + j, -generators(j, i));
  }
  for (Index j = 0; j < k; ++j) {
    form.row(0);
    form.entry(n + j, 1);
  }
  return form.finish();
}

LinearQuadratic monotone_cone(Index n) {
  LinearQuadraticBuilder form(n, 0);
  for (Index i = 0; i + 1 < n; ++i) {
    form.row(0);
    form.entry(i, -1);
    form.entry(i + 1, 1);
  }
  return form.finish();
}

}  // namespace convex::linear_quadratic
