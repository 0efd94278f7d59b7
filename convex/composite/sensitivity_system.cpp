#include "convex/composite/sensitivity_system.hpp"

#include <algorithm>
#include <cmath>

#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

/// A dt is eliminated where its b is at least this.
constexpr double pliable = 0.5;

/// Beyond so many rows its elimination would take longer than all steps before.
constexpr Index most_rows = 256;

}  // namespace

SensitivitySystem::SensitivitySystem(const SaddleProblem& problem, const Vector& t, const Vector& D,
                                     double theta, const Vector& ridge)
    : problem_(&problem) {
  // A step too far out of the range of doubles is no point to ask a Jacobian for.
  usable_ = t.allFinite() && problem.m <= most_rows;
  if (!usable_) return;
  const Index size = problem.n + problem.k;
  std::vector<Matrix> stiffness;  // by term B, of separable ones the diagonal alone
  Vector b = Vector::Zero(problem.m);
  for (const SaddleTerm& term : problem.terms) {
    const auto d = D.segment(term.first, term.rows);
    const Matrix J = term.f->prox_jacobian(t.segment(term.first, term.rows), d / term.scale);
    if (term.separable) {
      const Vector j = J.diagonal().cwiseMin(1.0).cwiseMax(0.0);
      slopes_.push_back(d.cwiseProduct(Vector(1 - j.array())));
      b.segment(term.first, term.rows) = j.array() + theta * (1 - j.array());
      stiffness.push_back(b.segment(term.first, term.rows));
    } else {  // D is a multiple of the identity here, so J is symmetric but for rounding
      const Matrix symmetric = 0.5 * (J + J.transpose());
      const Matrix rest = Matrix::Identity(term.rows, term.rows) - symmetric;
      slopes_.push_back(d.asDiagonal() * rest);
      stiffness.push_back(symmetric + theta * rest);
    }
  }
  keep_rows(b, size);
  const Index all = size + static_cast<Index>(kept_.size());
  WorkLimit::count(work_of_a_factor(all));
  std::vector<Index> place(static_cast<std::size_t>(problem.m), -1);
  for (std::size_t i = 0; i < kept_.size(); ++i)
    place[static_cast<std::size_t>(kept_[i])] = size + static_cast<Index>(i);
  eliminated_ = b.cwiseInverse();
  eliminated_(kept_).setZero();

  Matrix whole = Matrix::Zero(all, all);
  whole.topLeftCorner(size, size) = problem.G;
  whole.diagonal().segment(problem.n, problem.k) += ridge;
  for (std::size_t j = 0; j < problem.terms.size(); ++j) {
    const SaddleTerm& term = problem.terms[j];
    if (!term.separable) {
      const Index at = place[static_cast<std::size_t>(term.first)];
      whole.block(0, at, size, term.rows) = term.M.transpose() * slopes_[j];
      whole.block(at, 0, term.rows, size) = -Matrix(term.M);
      whole.block(at, at, term.rows, term.rows) = stiffness[j];
      continue;
    }
    const Vector h = slopes_[j].col(0).cwiseProduct(eliminated_.segment(term.first, term.rows));
    whole.topLeftCorner(size, size) += SparseMatrix(term.M.transpose() * h.asDiagonal() * term.M);
    for (Index c = 0; c < size; ++c)
      for (SparseMatrix::InnerIterator entry(term.M, c); entry; ++entry)
        if (const Index at = place[static_cast<std::size_t>(term.first + entry.row())]; at >= 0) {
          whole(c, at) = entry.value() * slopes_[j](entry.row(), 0);
          whole(at, c) = -entry.value();
          whole(at, at) = stiffness[j](entry.row(), 0);
        }
  }
  // Pivots are chosen among numbers of one size.
  const SparseMatrix squares = problem.M.cwiseAbs2();
  Vector scale = problem.G.diagonal() + squares.transpose() * D;
  scale.tail(problem.k) += ridge;
  const Vector root_of_D = Vector(D(kept_)).cwiseSqrt();
  for (double& x : scale) x = x > 0 ? 1 / std::sqrt(x) : 1;
  row_scale_.resize(all);
  column_scale_.resize(all);
  row_scale_ << scale, root_of_D;
  column_scale_ << scale, root_of_D.cwiseInverse();
  factor_ = linear_algebra::PivotedLu(row_scale_.asDiagonal() * whole * column_scale_.asDiagonal());
  usable_ = factor_.is_regular();
}

void SensitivitySystem::keep_rows(const Vector& b, Index most) {
  std::vector<Index> stiff;
  for (const SaddleTerm& term : problem_->terms)
    for (Index i = term.first; i < term.first + term.rows; ++i)
      if (!term.separable)
        kept_.push_back(i);
      else if (b[i] < pliable)
        stiff.push_back(i);
  // No more than so many are independent.
  const auto end = stiff.begin() + std::min<std::ptrdiff_t>(most, std::ssize(stiff));
  std::nth_element(stiff.begin(), end, stiff.end(), [&](Index i, Index k) { return b[i] < b[k]; });
  kept_.insert(kept_.end(), stiff.begin(), end);
}

Vector SensitivitySystem::slopes_of(const Vector& dt) const {
  Vector dy(dt.size());
  for (std::size_t j = 0; j < slopes_.size(); ++j) {
    const SaddleTerm& term = problem_->terms[j];
    const auto part = dt.segment(term.first, term.rows);
    auto image = dy.segment(term.first, term.rows);
    if (term.separable)
      image = slopes_[j].col(0).cwiseProduct(part);
    else
      image = slopes_[j] * part;
  }
  return dy;
}

NewtonStep SensitivitySystem::step(const Vector& rho, const Vector& r) const {
  Vector right(row_scale_.size());
  right << -rho - problem_->M.transpose() * slopes_of(eliminated_.cwiseProduct(r)), r(kept_);
  const Vector moved = column_scale_.cwiseProduct(factor_.solve(row_scale_.cwiseProduct(right)));
  NewtonStep step;
  step.dxi = moved.head(rho.size());
  step.dt = eliminated_.cwiseProduct(problem_->M * step.dxi + r);
  step.dt(kept_) = moved.tail(std::ssize(kept_));
  step.dy = slopes_of(step.dt);
  return step;
}

}  // namespace convex::inline composite
