#include "convex/linear_quadratic/functions.hpp"

#include <cmath>

#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/placement.hpp"
#include "convex/linear_quadratic/properness.hpp"

namespace convex::linear_quadratic {
namespace {

void require_weight(double weight, const char* where) {
  require(weight >= 0 && std::isfinite(weight), where, "the weight is negative or not finite; give one >= 0");
}

/// p(x) = c x + d on the left of b and e x + g on its right, as pieces.
LinearQuadratic two_pieces(Index n, double b, const Eigen::RowVector3d& left,
                           const Eigen::RowVector3d& right) {
  Matrix rows(2, 3);
  rows << left, right;
  return separable_pieces(n, Vector::Constant(1, b), rows);
}

}  // namespace

LinearQuadratic zero(Index n) { return LinearQuadraticBuilder(n, 0).finish(); }

LinearQuadratic constant(Index n, double value) {
  require(std::isfinite(value), "constant", "the value is not finite; give a number");
  return raise(zero(n), value);
}

LinearQuadratic linear(const Vector& c) { return tilt(zero(c.size()), c); }

LinearQuadratic quadratic(const Matrix& Q, const Vector& c) {
  /// A negative eigenvalue of this many roundings of the largest is that of a rounded semidefinite matrix.
  constexpr double eigenvalue_roundings = 64;
  const Index n = c.size();
  require(Q.rows() == n && Q.cols() == n, "quadratic", "Q and c do not fit; give Q n×n and c n");
  require(Q.allFinite() && c.allFinite(), "quadratic", "an entry is not finite; give numbers");
  const double largest = n > 0 ? Q.cwiseAbs().maxCoeff() : 0;
  require((Q - Q.transpose()).cwiseAbs().sum() <= 8 * unit_roundoff * largest * static_cast<double>(n * n),
          "quadratic", "Q is not symmetric; give its symmetric part");
  const Matrix symmetric = 0.5 * (Q + Q.transpose());
  if (n > 0 && largest > 0) {
    const Vector eigenvalues = linear_algebra::eigenvalues(symmetric);
    require(eigenvalues.minCoeff() >= -eigenvalue_roundings * static_cast<double>(n) * unit_roundoff *
                                          eigenvalues.cwiseAbs().maxCoeff(),
            "quadratic", "Q has a negative eigenvalue, so that the function is not convex; give Q >= 0");
  }
  LinearQuadratic f = linear(c);
  f.H = symmetric.sparseView(1, 0);
  return f;
}

LinearQuadratic squared_norm2(Index n, double weight) {
  require_weight(weight, "squared_norm2");
  LinearQuadraticBuilder form(n, 0);
  for (Index i = 0; i < n; ++i) form.curve(i, i, weight);
  return form.finish();
}

LinearQuadratic norm1(Index n, double weight) {
  require_weight(weight, "norm1");
  return two_pieces(n, 0, {0, -weight, 0}, {0, weight, 0});
}

LinearQuadratic norm_inf(Index n, double weight) {
  require_weight(weight, "norm_inf");
  LinearQuadraticBuilder form(n, 1);
  form.cost(n, weight);
  for (Index i = 0; i < n; ++i)
    for (double sign : {1.0, -1.0}) {
      form.row(0);
      form.entry(n, 1);
      form.entry(i, sign);
    }
  return form.finish();
}

LinearQuadratic huber(Index n, double mu) {
  require(mu > 0 && std::isfinite(mu), "huber", "mu is not positive and finite; give mu > 0");
  Vector breaks(2);
  breaks << -mu, mu;
  Matrix pieces(3, 3);
  pieces << 0, -1, -mu / 2, 1 / mu, 0, 0, 0, 1, -mu / 2;
  return separable_pieces(n, breaks, pieces);
}

LinearQuadratic max(Index n) {
  require(n >= 1, "max", "there is no entry; give n >= 1");
  return max_affine(Matrix::Identity(n, n), Vector::Zero(n));
}

LinearQuadratic sum_largest(Index n, Index count) {
  require(count >= 1 && count <= n, "sum_largest", "the count is not between 1 and n; give one that is");
  if (count == 1) return max(n);
  if (count == n) return linear(Vector::Ones(n));
  LinearQuadraticBuilder form(n, n + 1);
  form.cost(n, static_cast<double>(count));
  for (Index i = 0; i < n; ++i) {
    const Index above = n + 1 + i;
    form.cost(above, 1);
    form.row(0);
    form.entry(above, 1);
    form.row(0);
    form.entry(above, 1);
    form.entry(n, 1);
    form.entry(i, -1);
  }
  return form.finish();
}

LinearQuadratic max_affine(const Matrix& A, const Vector& b) {
  require(A.rows() == b.size() && b.size() > 0, "max_affine",
          "A and b do not fit; give one number for each row");
  require(A.allFinite() && b.allFinite(), "max_affine", "an entry is not finite; give numbers");
  const Index n = A.cols();
  if (A.rows() == 1) return raise(linear(A.row(0)), b[0]);
  LinearQuadraticBuilder form(n, 1);
  form.cost(n, 1);
  for (Index a = 0; a < A.rows(); ++a) {
    form.row(b[a]);
    form.entry(n, 1);
    for (Index i = 0; i < n; ++i)
      if (A(a, i) != 0) form.entry(i, -A(a, i));
  }
  return form.finish();
}

LinearQuadratic hinge(Index n) { return two_pieces(n, 1, {0, -1, 1}, {0, 0, 0}); }

LinearQuadratic squared_hinge(Index n) { return two_pieces(n, 1, {2, -2, 1}, {0, 0, 0}); }

LinearQuadratic elastic_net(Index n, double l1, double l2) {
  require_weight(l1, "elastic_net");
  require_weight(l2, "elastic_net");
  return two_pieces(n, 0, {l2, -l1, 0}, {l2, l1, 0});
}

LinearQuadratic total_variation(Index n, double weight) {
  require_weight(weight, "total_variation");
  if (n < 2) return zero(n);
  Entries entries = identity_at(n - 1, 0, -1);
  append(entries, identity_at(n - 1, 1, 1));
  SparseMatrix D(n - 1, n);
  D.setFromTriplets(entries.begin(), entries.end());
  return precompose(norm1(n - 1, weight), D, Vector::Zero(n - 1));
}

LinearQuadratic support(const LinearQuadratic& set) {
  require_proper(set, "support");
  require(set.polyhedral() && set.c.cwiseAbs().sum() == 0 && set.constant == 0, "support",
          "that is not the indicator of a set; give one");
  return conjugate(set);
}

}  // namespace convex::linear_quadratic
