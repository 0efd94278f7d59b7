#include "convex/sparse_gram.hpp"

#include <cmath>
#include <vector>

#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex {
namespace {

/// Inverse iteration finds the least eigenvalue from above but for this factor.
constexpr double safety = 4;
constexpr int most_iterations = 40;

double least_eigenvalue(const linear_algebra::SparseCholesky& LLT, const Vector& diagonal) {
  const Vector root = diagonal.cwiseSqrt();
  Vector x(diagonal.size());
  for (Index i = 0; i < x.size(); ++i)
    x[i] = 1 + 0.5 * std::sin(static_cast<double>(i * i + i));  // no pattern
  double norm = 1;
  for (int k = 0; k < most_iterations && std::isfinite(norm) && norm > 0; ++k) {
    x = LLT.solve(Vector(x.cwiseProduct(root) / x.norm())).cwiseProduct(root);
    norm = x.norm();
  }
  return 1 / norm;
}

[[noreturn]] void refuse_indefinite() {
  throw InvalidInput(
      "A: not positive definite to working precision; give a symmetric positive definite matrix");
}

}  // namespace

Vector excess_if_plainly_definite(const SparseMatrix& W, double least_pivot) {
  const Index n = W.rows();
  Vector excess(n), diagonal(n), resistance(n);
  std::vector<int> reached;  // nodes with a path to the ground, nearest first as far as steps go
  reached.reserve(static_cast<std::size_t>(n));
  const auto is_firm = [&](Index j) { return resistance[j] * diagonal[j] * least_pivot < 0.5; };
  bool all_firm = true;  // by paths to nodes before, as nodes of a grid have them
  for (Index j = 0; j < n; ++j) {
    RunningSum sum;
    double nearest = -1, link = 1;
    for (SparseMatrix::InnerIterator it(W, j); it; ++it) {
      const Index i = it.row();
      if (i == j) diagonal[j] = it.value();
      const double size = std::abs(it.value());
      sum.add(i == j ? it.value() : -size);
      if (i >= j || !(size > 0) || resistance[i] < 0 || (nearest >= 0 && nearest <= resistance[i])) continue;
      nearest = resistance[i];
      link = size;
    }
    excess[j] = std::abs(sum.value()) <= zero_of_long_sums * diagonal[j] ? 0 : sum.value();
    if (excess[j] < 0) return {};
    const bool grounded = excess[j] > 2 * least_pivot * diagonal[j];
    resistance[j] = grounded ? 1 / excess[j] : nearest >= 0 ? nearest + 1 / link : -1;
    if (grounded) reached.push_back(static_cast<int>(j));
    all_firm = all_firm && resistance[j] >= 0 && is_firm(j);
  }
  if (all_firm) return excess;
  resistance.setConstant(-1);
  for (const int j : reached) resistance[j] = 1 / excess[j];
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const Index j = reached[k];
    if (!is_firm(j)) return {};
    for (SparseMatrix::InnerIterator it(W, j); it; ++it) {
      double& there = resistance[it.row()];
      if (there >= 0 || !(std::abs(it.value()) > 0)) continue;
      there = resistance[j] + 1 / std::abs(it.value());
      reached.push_back(static_cast<int>(it.row()));
    }
  }
  return static_cast<Index>(reached.size()) == n ? excess : Vector();
}

SparseGram::SparseGram(SparseMatrix&& W, double least_pivot) : least_pivot_(least_pivot) {
  W_.swap(W);  // Eigen 3.4 would make a copy of what is moved
  excess_ = excess_if_plainly_definite(W_, least_pivot);
  if (excess_.size() == 0) factor();
}

const SparseGram::Factor& SparseGram::factor() const {
  std::call_once(made_, [this] {
    linear_algebra::SparseCholesky LLT(W_);
    if (!LLT.is_definite()) refuse_indefinite();
    const Vector permuted = LLT.permuted(W_.diagonal());
    const double smallest = (LLT.diagonal().array().square() / permuted.array()).minCoeff();
    if (!(smallest > least_pivot_)) refuse_indefinite();
    if (smallest < plain_pivot && !(least_eigenvalue(LLT, W_.diagonal()) > safety * least_pivot_))
      refuse_indefinite();
    factor_ = std::make_unique<const Factor>(Factor{std::move(LLT), 1 / std::sqrt(smallest)});
  });
  return *factor_;
}

double SparseGram::norm(const Vector& x) const {
  if (excess_.size() == 0) return factor().LLT.times_upper(factor().LLT.permuted(x)).norm();
  // Σ excess_i x_i² + Σ |w_ij| (x_i ± x_j)²: no term is negative, so none cancels.
  double energy = 0;
  for (Index j = 0; j < W_.cols(); ++j) {
    double column = excess_[j] * x[j] * x[j];
    for (SparseMatrix::InnerIterator it(W_, j); it && it.row() < j; ++it) {
      const double way = it.value() < 0 ? x[it.row()] - x[j] : x[it.row()] + x[j];
      column += std::abs(it.value()) * way * way;
    }
    energy += column;
  }
  return std::sqrt(energy);
}

void SparseGram::whiten_in_place(Eigen::Ref<Matrix> C) const {
  Matrix permuted = factor().LLT.permuted_columns(C);
  factor().LLT.solve_lower_in_place(permuted);
  C = permuted;
}

void SparseGram::unwhiten_in_place(Eigen::Ref<Vector> w) const {
  Vector permuted = w;
  factor().LLT.solve_upper_in_place(permuted);
  w = factor().LLT.permuted_back(permuted);
}

double SparseGram::factor_condition() const { return factor().condition; }

bool is_exactly_symmetric(const SparseMatrix& W) {
  if (!W.isCompressed()) return false;
  const Index n = W.rows();
  const int *const start = W.outerIndexPtr(), *const row = W.innerIndexPtr();
  const double* const value = W.valuePtr();
  std::vector<int> next(start, start + n);  // the first entry above the diagonal that has no like yet
  for (Index j = 0; j < n; ++j) {
    int at = next[static_cast<std::size_t>(j)];
    if (at < start[j + 1] && row[at] < j) return false;
    for (; at < start[j + 1]; ++at) {
      if (!std::isfinite(value[at])) return false;
      if (row[at] == j) continue;
      int& like = next[static_cast<std::size_t>(row[at])];
      if (like == start[row[at] + 1] || row[like] != j || value[like] != value[at]) return false;
      ++like;
    }
  }
  return true;
}

}  // namespace convex
