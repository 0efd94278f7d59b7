#include "convex/composite/newton_system.hpp"

#include <cmath>

#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

/// So many multiplications take as long as an evaluation of a function of one variable.
constexpr double multiplications_of_an_evaluation = 1000;

/// What the dense factors count as.
long work_of(const SaddleProblem& problem, Index unknowns) {
  long sum = work_of_a_factor(unknowns);
  for (const SaddleTerm& term : problem.terms)
    if (!term.separable) sum += work_of_a_factor(term.rows);
  return sum;
}

/// A matrix that is not definite after its diagonal grew by this part is not so by rounding.
constexpr double largest_lift = 1e-9;

TermCurvature curvature_of(const SaddleTerm& term, const Vector& t, const Vector& D, double theta,
                           bool& usable) {
  const Matrix J = term.f->prox_jacobian(t, D / term.scale);
  TermCurvature curvature;
  curvature.diagonal = term.separable;
  if (term.separable) {
    const Vector j = J.diagonal().cwiseMin(1.0).cwiseMax(0.0);
    curvature.b_inverse = (j.array() + theta * (1 - j.array())).inverse();
    curvature.h = D.array() * (1 - j.array()) * curvature.b_inverse.array();
    return curvature;
  }
  // D is a multiple of the identity here, so J is symmetric but for rounding.
  const Matrix symmetric = 0.5 * (J + J.transpose());
  Matrix B = (1 - theta) * symmetric;
  B.diagonal().array() += theta;
  linear_algebra::Cholesky factor(B);
  if (!factor.is_definite()) {
    // A Jacobian that is indefinite by rounding, more than theta covers.
    constexpr double widening = 1e-8;
    B.diagonal().array() += widening;
    factor = linear_algebra::Cholesky(B);
    usable = usable && factor.is_definite();
  }
  curvature.B_inverse = factor.inverse();
  Matrix complement = -symmetric;
  complement.diagonal().array() += 1;
  const Matrix H = factor.solve_columns(complement);
  curvature.H = 0.5 * D[0] * (H + H.transpose());
  return curvature;
}

}  // namespace

long work_of_a_factor(Index unknowns) {
  return static_cast<long>(std::pow(static_cast<double>(unknowns), 3) / multiplications_of_an_evaluation);
}

NewtonSystem::NewtonSystem(const SaddleProblem& problem, const Vector& t, const Vector& D, double theta,
                           const Vector& ridge)
    : problem_(&problem) {
  Matrix system = problem.G;
  WorkLimit::count(work_of(problem, system.rows()));
  // A step too far out of the range of doubles is no point to ask a Jacobian for.
  usable_ = t.allFinite();
  if (!usable_) return;
  system.diagonal().tail(problem.k) += ridge;
  for (const SaddleTerm& term : problem.terms) {
    curvature_.push_back(curvature_of(term, t.segment(term.first, term.rows),
                                      D.segment(term.first, term.rows), theta, usable_));
    const TermCurvature& curvature = curvature_.back();
    const SparseMatrix transposed = term.M.transpose();
    if (curvature.diagonal) {
      const SparseMatrix product = transposed * curvature.h.asDiagonal() * term.M;
      system += product;
    } else {
      const Matrix product = curvature.H * term.M;
      system += transposed * product;
    }
  }
  factor_ = linear_algebra::Cholesky(system);
  // The rounding of stiff terms can outweigh the ridge in a direction that nothing else holds.
  for (double part = unit_roundoff; !factor_.is_definite() && part < largest_lift; part *= 16) {
    Matrix lifted = system;
    lifted.diagonal() *= 1 + part;
    factor_ = linear_algebra::Cholesky(lifted);
  }
  usable_ = usable_ && factor_.is_definite();
}

NewtonStep NewtonSystem::step(const Vector& rho, const Vector& r) const {
  const auto apply = [&](const Vector& moved, bool to_y) {
    Vector image(problem_->m);
    for (std::size_t j = 0; j < curvature_.size(); ++j) {
      const SaddleTerm& term = problem_->terms[j];
      const TermCurvature& at = curvature_[j];
      const auto part = moved.segment(term.first, term.rows);
      auto out = image.segment(term.first, term.rows);
      if (at.diagonal)
        out = (to_y ? at.h : at.b_inverse).cwiseProduct(part);
      else
        out = (to_y ? at.H : at.B_inverse) * part;
    }
    return image;
  };
  NewtonStep step;
  step.dxi = factor_.solve(-rho - problem_->M.transpose() * apply(r, true));
  const Vector moved = problem_->M * step.dxi + r;
  step.dt = apply(moved, false);
  step.dy = apply(moved, true);
  return step;
}

}  // namespace convex::inline composite
