#include "convex/composite/sensitivity_system.hpp"

#include <cmath>

#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {

SensitivitySystem::SensitivitySystem(const SaddleProblem& problem, const Vector& t, const Vector& D,
                                     double theta, const Vector& ridge)
    : size_(problem.n + problem.k) {
  const Index all = size_ + problem.m;
  WorkLimit::count(work_of_a_factor(all));
  // A step too far out of the range of doubles is no point to ask a Jacobian for.
  usable_ = t.allFinite();
  if (!usable_) return;
  Matrix whole = Matrix::Zero(all, all);
  whole.topLeftCorner(size_, size_) = problem.G;
  whole.diagonal().segment(problem.n, problem.k) += ridge;
  whole.bottomLeftCorner(problem.m, size_) = -Matrix(problem.M);
  for (const SaddleTerm& term : problem.terms) {
    const auto d = D.segment(term.first, term.rows);
    Matrix J = term.f->prox_jacobian(t.segment(term.first, term.rows), d / term.scale);
    // In the metric D of a term whose rows are not apart, a multiple of the identity, J is symmetric.
    J = term.separable ? Matrix(J.diagonal().cwiseMin(1.0).cwiseMax(0.0).asDiagonal())
                       : Matrix(0.5 * (J + J.transpose()));
    const Matrix rest = Matrix::Identity(term.rows, term.rows) - J;
    first_.push_back(term.first);
    slopes_.push_back(d.asDiagonal() * rest);
    whole.block(0, size_ + term.first, size_, term.rows) = term.M.transpose() * slopes_.back();
    whole.block(size_ + term.first, size_ + term.first, term.rows, term.rows) = J + theta * rest;
  }
  const SparseMatrix squares = problem.M.cwiseAbs2();
  Vector size = problem.G.diagonal() + squares.transpose() * D;
  size.tail(problem.k) += ridge;
  column_scale_.resize(all);
  row_scale_.resize(all);
  for (Index i = 0; i < size_; ++i)
    row_scale_[i] = column_scale_[i] = size[i] > 0 ? 1 / std::sqrt(size[i]) : 1;
  row_scale_.tail(problem.m) = D.cwiseSqrt();
  column_scale_.tail(problem.m) = D.cwiseSqrt().cwiseInverse();
  factor_ = linear_algebra::PivotedLu(row_scale_.asDiagonal() * whole * column_scale_.asDiagonal());
  usable_ = factor_.is_regular();
}

NewtonStep SensitivitySystem::step(const Vector& rho, const Vector& r) const {
  Vector right(rho.size() + r.size());
  right << -rho, r;
  const Vector moved = column_scale_.cwiseProduct(factor_.solve(row_scale_.cwiseProduct(right)));
  NewtonStep step{moved.head(size_), moved.tail(r.size()), Vector(r.size())};
  for (std::size_t j = 0; j < slopes_.size(); ++j)
    step.dy.segment(first_[j], slopes_[j].rows()) =
        slopes_[j] * step.dt.segment(first_[j], slopes_[j].rows());
  return step;
}

}  // namespace convex::inline composite
