#include "convex/nearest_point/gallery/planted.hpp"

#include <numeric>
#include <utility>

namespace convex::inline families {

Matrix integer_inertia(Index n, Draw& draw) {
  Matrix B(n, n);
  for (Index i = 0; i < B.size(); ++i) B.data()[i] = draw.integer(-2, 2);
  return B * B.transpose() + static_cast<double>(n) * Matrix::Identity(n, n);
}

Vector integer_row(Index n, Draw& draw) {
  Vector u = draw.integers(n, -3, 3);
  if (u.cwiseAbs().maxCoeff() < 0.5) u[draw.index(n)] = 1;
  return u;
}

void PlantedRows::add_apart(Index count, Draw& draw) {
  for (Index a = 0; a < count; ++a) {
    const Vector u = integer_row(q_.size(), draw);
    add(u, 0, draw.integer(1, 8));
  }
}

GalleryInstance PlantedRows::instance(Draw& draw) const {
  const Index n = q_.size(), m = count();
  std::vector<Index> order(at(m));
  std::iota(order.begin(), order.end(), Index{0});
  for (Index a = m - 1; a > 0; --a) std::swap(order[at(a)], order[at(draw.index(a + 1))]);
  RowMatrix U(m, n);
  Vector lambda(m), slack(m);
  for (Index a = 0; a < m; ++a) {
    const auto from = at(order[static_cast<std::size_t>(a)]);
    U.row(a) = rows_[from];
    lambda[a] = lambda_[from];
    slack[a] = slack_[from];
  }
  const Vector s = U * q_ - slack;
  GalleryInstance instance{
      {Metric::dense(A_), {}, ConstraintRows(U), s, {}}, true, DoubleDoubleVector(q_), lambda, Vector(0)};
  DoubleDoubleVector linear(A_ * q_);  // large multipliers of opposite rows cancel without a rounding
  for (Index a = 0; a < m; ++a) instance.problem.U.add_multiple(a, {-lambda[a], 0}, linear);
  instance.problem.z = linear.value();
  return instance;
}

}  // namespace convex::inline families
