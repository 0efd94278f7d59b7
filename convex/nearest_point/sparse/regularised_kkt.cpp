#include "convex/nearest_point/sparse/regularised_kkt.hpp"

#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_algebra/sparse_cholesky.hpp"
#include "convex/nearest_point/reductions/balanced_problem.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline sparse {

struct RegularisedKkt::Dense {
  Matrix all;  // F⁻¹u_a of all rows
  Matrix V;    // of the rows J
  Vector theta;
  bool in_space = true;  // the factor is that of I + V Theta⁻¹Vᵀ
  linear_algebra::Cholesky factor;
};

struct RegularisedKkt::Sparse {
  SparseMatrix A;
  linear_algebra::SparseLdlt factor;
};

RegularisedKkt::RegularisedKkt(const NearestPointProblem& problem) : problem_(problem) {
  if (is_dense_size(problem)) {
    dense_ = std::make_unique<Dense>();
    dense_->all = whitened_rows(problem, indices_below(problem.rows()));
    return;
  }
  sparse_ = std::make_unique<Sparse>();
  sparse_->A = sparse_gram(problem.A);
}

RegularisedKkt::~RegularisedKkt() = default;

bool RegularisedKkt::factor(const std::vector<Index>& rows, const Vector& theta) {
  const Index n = problem_.dimension(), k = static_cast<Index>(rows.size());
  if (dense_) {
    dense_->theta = theta;
    dense_->V.resize(n, k);
    for (Index j = 0; j < k; ++j) dense_->V.col(j) = dense_->all.col(rows[static_cast<std::size_t>(j)]);
    dense_->in_space = n < k;
    Matrix gram;
    if (dense_->in_space) {
      const Matrix scaled = dense_->V * theta.cwiseSqrt().cwiseInverse().asDiagonal();
      gram.setIdentity(n, n);
      gram.selfadjointView<Eigen::Lower>().rankUpdate(scaled);
    } else {
      gram = Matrix(theta.asDiagonal());
      if (k > 0) gram.selfadjointView<Eigen::Lower>().rankUpdate(dense_->V.transpose());
    }
    dense_->factor = linear_algebra::Cholesky(gram);
    return dense_->factor.is_definite();
  }
  // The lower triangle of [A, Uᵀ; U, -Theta] for (dq, -dlambda).
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < n; ++j)
    for (SparseMatrix::InnerIterator it(sparse_->A, j); it; ++it)
      if (it.row() >= j) entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(j), it.value());
  for (Index i = 0; i < k; ++i) {
    const Index a = rows[static_cast<std::size_t>(i)];
    const int at = static_cast<int>(n + i);
    problem_.U.for_each_entry(
        a, [&](Index j, double value) { entries.emplace_back(at, static_cast<int>(j), value); });
    entries.emplace_back(at, at, -theta[i]);
  }
  SparseMatrix whole(n + k, n + k);
  whole.setFromTriplets(entries.begin(), entries.end());
  return sparse_->factor.factor(whole);
}

void RegularisedKkt::solve(const Vector& r1, const Vector& r2, Vector& dq, Vector& dlambda) const {
  if (dense_) {
    const Matrix& V = dense_->V;
    const Vector g = problem_.A.whiten(r1);
    Vector dw;
    if (dense_->in_space) {
      dw = dense_->factor.solve(g + V * r2.cwiseQuotient(dense_->theta));
      dlambda = (r2 - V.transpose() * dw).cwiseQuotient(dense_->theta);
    } else {
      dlambda = dense_->factor.solve(r2 - V.transpose() * g);
      dw = g + V * dlambda;
    }
    dq = problem_.A.unwhiten(dw);
    return;
  }
  const Index n = problem_.dimension(), k = r2.size();
  Vector r(n + k);
  r << r1, r2;
  const Vector x = sparse_->factor.solve(r);
  dq = x.head(n);
  dlambda = -x.tail(k);
}

}  // namespace convex::inline sparse
