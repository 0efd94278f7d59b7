#include "convex/composite/newton_system.hpp"

#include <cmath>

#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

/// So many multiplications take as long as an evaluation of a function of one variable.
constexpr double multiplications_of_an_evaluation = 1000;

/// A sparse matrix is factored as one from `Jacobian::least_thin` unknowns on, where at most the part of it
/// is there, and the thin Jacobians have at most the other part of columns.
constexpr double sparse_part = 0.125, thin_part = 0.125;

/// A matrix that is not definite after its diagonal grew by this part is not so by rounding.
constexpr double largest_lift = 1e-9;

/// B = diag(beta) + (1 - theta) U C Uᵀ, inverted by the formula of Woodbury.
TermCurvature thin_curvature(const Jacobian& J, const Vector& D, double theta, bool& usable) {
  TermCurvature curvature;
  curvature.is_thin = true;
  const Vector a = J.a().cwiseMin(1.0).cwiseMax(0.0);
  curvature.b_inverse = (a.array() + theta * (1 - a.array())).inverse();
  curvature.h = D.array() * (1 - a.array()) * curvature.b_inverse.array();
  const Index r = J.U().cols();
  curvature.P = curvature.b_inverse.asDiagonal() * J.U();
  curvature.S.resize(r, r);
  if (r == 0) return curvature;
  // S = C K⁻¹, K = I + (1 - theta) Uᵀ diag(beta)⁻¹ U C; it is symmetric as C is.
  const Matrix K = Matrix::Identity(r, r) + (1 - theta) * (J.U().transpose() * curvature.P) * J.C();
  const linear_algebra::PivotedLu factor(K.transpose());
  usable = usable && factor.is_regular();
  if (!usable) return curvature;
  for (Index k = 0; k < r; ++k) curvature.S.row(k) = factor.solve(J.C().col(k)).transpose();
  curvature.S = (0.5 * (curvature.S + curvature.S.transpose())).eval();
  return curvature;
}

TermCurvature curvature_of(const SaddleTerm& term, const Vector& t, const Vector& D, double theta,
                           bool& usable) {
  const Jacobian J = term.f->prox_jacobian(t, D / term.scale);
  if (term.separable) return thin_curvature(Jacobian(J.diagonal()), D, theta, usable);
  // What is stiff in one direction and pliable in others is seen more closely by a full matrix.
  if (J.is_thin() && term.rows >= Jacobian::least_thin) return thin_curvature(J, D, theta, usable);
  TermCurvature curvature;
  WorkLimit::count(work_of_a_factor(term.rows));
  // D is a multiple of the identity here, so J is symmetric but for rounding.
  const Matrix full = J, symmetric = 0.5 * (full + full.transpose());
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
    : problem_(&problem), theta_(theta), scale_(D) {
  // A step too far out of the range of doubles is no point to ask a Jacobian for.
  usable_ = t.allFinite();
  if (!usable_) return;
  for (const SaddleTerm& term : problem.terms)
    curvature_.push_back(curvature_of(term, t.segment(term.first, term.rows),
                                      D.segment(term.first, term.rows), theta, usable_));
  if (usable_ && !factor_sparse(ridge)) factor_dense(ridge);
}

void NewtonSystem::factor_dense(const Vector& ridge) {
  const SaddleProblem& problem = *problem_;
  Matrix system = problem.G;
  WorkLimit::count(work_of_a_factor(system.rows()));
  system.diagonal().tail(problem.k) += ridge;
  for (std::size_t j = 0; j < curvature_.size(); ++j) {
    const SaddleTerm& term = problem.terms[j];
    const TermCurvature& curvature = curvature_[j];
    const SparseMatrix transposed = term.M.transpose();
    if (!curvature.is_thin) {
      const Matrix product = curvature.H * term.M;
      system += transposed * product;
      continue;
    }
    const SparseMatrix product = transposed * curvature.h.asDiagonal() * term.M;
    system += product;
    if (curvature.P.cols() == 0) continue;
    const Matrix image = transposed * curvature.P;
    system -= image * (scale_[term.first] * curvature.S) * image.transpose();
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

bool NewtonSystem::factor_sparse(const Vector& ridge) {
  const SaddleProblem& problem = *problem_;
  const Index size = problem.n + problem.k;
  if (size < Jacobian::least_thin || problem.sparse_G.size() == 0) return false;
  Index thin = 0;
  for (const TermCurvature& curvature : curvature_) {
    if (!curvature.is_thin) return false;
    thin += curvature.P.cols();
  }
  if (static_cast<double>(thin) > thin_part * static_cast<double>(size)) return false;
  SparseMatrix system = problem.sparse_G;
  columns_ = Matrix::Zero(size, thin);
  weight_ = Matrix::Zero(thin, thin);
  Index first = 0;
  for (std::size_t j = 0; j < curvature_.size(); ++j) {
    const SaddleTerm& term = problem.terms[j];
    const TermCurvature& curvature = curvature_[j];
    system += SparseMatrix(term.M.transpose() * curvature.h.asDiagonal() * term.M);
    const Index r = curvature.P.cols();
    if (r > 0) {
      columns_.middleCols(first, r) = term.M.transpose() * curvature.P;
      weight_.block(first, first, r, r) = -scale_[term.first] * curvature.S;
    }
    first += r;
  }
  const auto whole = static_cast<double>(size) * static_cast<double>(size);
  if (static_cast<double>(system.nonZeros()) > sparse_part * whole) return false;
  std::vector<linear_algebra::SparseFactor::Place> places;
  for (Index c = 0; c < size; ++c)
    for (SparseMatrix::InnerIterator entry(system, c); entry && entry.row() <= c; ++entry)
      places.push_back({static_cast<int>(entry.row()), static_cast<int>(c)});
  for (Index i = 0; i < problem.k; ++i)
    places.push_back({static_cast<int>(problem.n + i), static_cast<int>(problem.n + i)});
  sparse_.emplace(size, places);
  const std::vector<Index> slots = sparse_->slots(places);
  sparse_->clear_values();
  std::size_t next = 0;
  for (Index c = 0; c < size; ++c)
    for (SparseMatrix::InnerIterator entry(system, c); entry && entry.row() <= c; ++entry)
      sparse_->values()[at(slots[next++])] += entry.value();
  for (Index i = 0; i < problem.k; ++i) sparse_->values()[at(slots[next++])] += ridge[i];
  WorkLimit::count(static_cast<long>((sparse_->flops() + static_cast<double>(thin * thin * size)) /
                                     multiplications_of_an_evaluation));
  if (!sparse_->factor() || !(sparse_->pivots().array() > 0).all()) {
    sparse_.reset();
    return false;
  }
  spread_ = columns_;
  for (Index k = 0; k < thin; ++k) {
    Vector column = columns_.col(k);
    sparse_->solve(column);
    spread_.col(k) = column;
  }
  small_ =
      linear_algebra::PivotedLu(Matrix::Identity(thin, thin) + weight_ * (columns_.transpose() * spread_));
  if (thin > 0 && !small_.is_regular()) sparse_.reset();
  return sparse_.has_value();
}

/// (K + Y E Yᵀ)⁻¹b = K⁻¹b - K⁻¹Y (I + E YᵀK⁻¹Y)⁻¹ E YᵀK⁻¹b.
Vector NewtonSystem::solve(const Vector& right) const {
  if (!sparse_) return factor_.solve(right);
  Vector found = right;
  sparse_->solve(found);
  if (columns_.cols() > 0) found -= spread_ * small_.solve(weight_ * (columns_.transpose() * found));
  return found;
}

NewtonStep NewtonSystem::step(const Vector& rho, const Vector& r) const {
  const auto apply = [&](const Vector& moved, bool to_y) {
    Vector image(problem_->m);
    for (std::size_t j = 0; j < curvature_.size(); ++j) {
      const SaddleTerm& term = problem_->terms[j];
      const TermCurvature& at = curvature_[j];
      const auto part = moved.segment(term.first, term.rows);
      auto out = image.segment(term.first, term.rows);
      if (!at.is_thin) {
        out = (to_y ? at.H : at.B_inverse) * part;
        continue;
      }
      out = (to_y ? at.h : at.b_inverse).cwiseProduct(part);
      if (at.P.cols() > 0)
        out -= (to_y ? scale_[term.first] : 1 - theta_) * (at.P * (at.S * (at.P.transpose() * part)));
    }
    return image;
  };
  NewtonStep step;
  step.dxi = solve(-rho - problem_->M.transpose() * apply(r, true));
  const Vector moved = problem_->M * step.dxi + r;
  step.dt = apply(moved, false);
  step.dy = apply(moved, true);
  return step;
}

}  // namespace convex::inline composite
