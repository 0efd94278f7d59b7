#include "convex/nearest_point/sensitivity.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/nearest_point/active_set.hpp"
#include "convex/nearest_point/working_set.hpp"

namespace convex {
namespace {

std::vector<bool> marked(Index size, const std::vector<Index>& rows) {
  std::vector<bool> mark(static_cast<std::size_t>(size), false);
  for (Index a : rows) mark[static_cast<std::size_t>(a)] = true;
  return mark;
}

/// Multipliers that are this part of the largest push, each measured by its row's length, count as 0.
constexpr double weak = 1e-12;

/// By row: two-sided, or with a multiplier that is not 0.
std::vector<bool> loaded_rows(const NearestPointProblem& problem, const Multipliers& multipliers) {
  std::vector<bool> loaded = marked(problem.rows(), problem.two_sided);
  const Vector push =
      multipliers.least_norm.cwiseAbs().cwiseProduct(problem.U.lengths(problem.A.diagonal().cwiseInverse()));
  const double largest = push.size() > 0 ? push.maxCoeff() : 0;
  for (Index a = 0; a < push.size(); ++a)
    if (push[a] > weak * largest) loaded[static_cast<std::size_t>(a)] = true;
  return loaded;
}

}  // namespace

std::optional<Derivative> directional_derivative(const NearestPointProblem& problem, const Solution&,
                                                 const Multipliers& multipliers, const Vector& dz,
                                                 const Vector& ds) {
  if (!multipliers.unique && (ds.array() != 0).any()) return std::nullopt;
  const std::vector<bool> loaded = loaded_rows(problem, multipliers);
  const std::vector<Index>& tight = multipliers.tight;
  NearestPointProblem face{
      problem.A, dz, problem.U.select(tight), Vector(static_cast<Index>(tight.size())), {}};
  for (std::size_t k = 0; k < tight.size(); ++k) {
    face.s[static_cast<Index>(k)] = ds[tight[k]];
    if (loaded[static_cast<std::size_t>(tight[k])]) face.two_sided.push_back(static_cast<Index>(k));
  }
  const Solution moved = active_set(face, {.limit = 0});
  if (moved.q.size() != problem.dimension()) return std::nullopt;
  Derivative found{moved.q, face.U.transpose_times(moved.lambda), std::nullopt};
  if (multipliers.unique) {
    found.multipliers = Vector::Zero(problem.rows());
    for (std::size_t k = 0; k < tight.size(); ++k)
      (*found.multipliers)[tight[k]] = moved.lambda[static_cast<Index>(k)];
  }
  return found;
}

std::optional<Vector> margins(const NearestPointProblem& problem, const Solution& solution,
                              const Multipliers& multipliers) {
  if (!multipliers.unique) return std::nullopt;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Index m = problem.rows();
  const std::vector<bool> loaded = loaded_rows(problem, multipliers),
                          two_sided = marked(m, problem.two_sided);
  std::vector<Index> held;
  for (Index a : solution.basis)
    if (loaded[static_cast<std::size_t>(a)]) held.push_back(a);
  const auto k = static_cast<Index>(held.size());
  Matrix Q(problem.dimension(), 0), R_inverse(0, 0);
  if (k > 0) {
    const Eigen::HouseholderQR<Matrix> factor(whitened_rows(problem, held));
    Q = factor.householderQ() * Matrix::Identity(problem.dimension(), k);
    R_inverse = Matrix::Identity(k, k);
    factor.matrixQR().topRows(k).triangularView<Eigen::Upper>().solveInPlace(R_inverse);
  }
  Vector found = Vector::Constant(m, infinity);
  for (Index r = 0; r < k; ++r) {
    // dlambda = (VᵀV)⁻¹Vᵀ F⁻¹dz, whose row r has the length |R⁻¹|_r.
    const Index a = held[static_cast<std::size_t>(r)];
    if (!two_sided[static_cast<std::size_t>(a)])
      found[a] = std::max(0.0, multipliers.least_norm[a]) / R_inverse.row(r).norm();
  }
  const std::vector<bool> is_tight = marked(m, multipliers.tight), is_held = marked(m, held);
  std::vector<Index> others;
  for (Index a = 0; a < m; ++a)
    if (!is_held[static_cast<std::size_t>(a)] && !two_sided[static_cast<std::size_t>(a)]) others.push_back(a);
  const Matrix V = whitened_rows(problem, others);
  const Matrix free = V - Q * (Q.transpose() * V);
  for (std::size_t j = 0; j < others.size(); ++j) {
    const Index a = others[j];
    const double reach = free.col(static_cast<Index>(j)).norm(), length = V.col(static_cast<Index>(j)).norm();
    const bool reachable = reach > 64 * unit_roundoff * static_cast<double>(problem.dimension()) * length;
    if (is_tight[static_cast<std::size_t>(a)])
      found[a] = 0;
    else if (reachable)
      found[a] = std::max(0.0, solution.slack[a]) / reach;
  }
  return found;
}

}  // namespace convex
