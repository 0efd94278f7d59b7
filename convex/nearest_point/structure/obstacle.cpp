#include "convex/nearest_point/structure/obstacle.hpp"

#include <cmath>
#include <limits>

#include "convex/double_double.hpp"
#include "convex/nearest_point/residuals.hpp"
#include "convex/nearest_point/structure/grid_multigrid.hpp"

namespace convex {
namespace {

constexpr double none = -std::numeric_limits<double>::infinity();

/// Active sets tried on one grid; residuals left to conjugate gradients while these are sought, and in a
/// refinement.
constexpr int most_sets = 60, most_refinements = 12;
constexpr double rough = 1e-3, fine = 1e-6;
/// What may be missing at the end, relative to the scale.
constexpr double enough = 0x1p-58;

/// An obstacle problem on one grid, fields with frames.
struct GridProblem {
  GridOperator A;
  Vector z, lower;  ///< lower: -inf where there is no bound
};

std::optional<GridProblem> grid_problem(const NearestPointProblem& problem) {
  constexpr Index smallest = 8;
  if (problem.A.kind() != MetricKind::sparse || !problem.U.is_sparse() || !problem.two_sided.empty())
    return std::nullopt;
  const SparseMatrix& W = problem.A.sparse_gram();
  const Index n = W.rows();
  SparseMatrix::InnerIterator first(W, 0);
  if (!first || first.row() != 0) return std::nullopt;
  GridProblem grid;
  grid.A.d = first.value();
  ++first;
  if (!first || first.row() != 1) return std::nullopt;
  grid.A.c = -first.value();
  ++first;
  if (!first || n % first.row() != 0) return std::nullopt;
  const Index width = first.row();
  grid.A.width = width;
  grid.A.height = n / width;
  if (std::min(width, grid.A.height) < smallest || !(grid.A.c > 0) || !(grid.A.d >= 4 * grid.A.c))
    return std::nullopt;
  for (Index k = 0; k < n; ++k) {
    Index expected = 1 + (k % width > 0) + (k % width + 1 < width) + (k >= width) + (k + width < n);
    for (SparseMatrix::InnerIterator it(W, k); it; ++it, --expected) {
      const Index by = std::abs(it.row() - k);
      const bool beside = by == 1 && it.row() / width == k / width;
      if (by == 0 ? it.value() != grid.A.d : (!(beside || by == width) || it.value() != -grid.A.c))
        return std::nullopt;
    }
    if (expected != 0) return std::nullopt;
  }
  grid.z = grid.A.field();
  grid.lower = Vector::Constant(grid.A.size(), none);
  grid.A.free = grid.A.field();
  for (Index k = 0; k < n; ++k) grid.z[grid.A.at(k % width, k / width)] = problem.z[k];
  for (Index a = 0; a < problem.rows(); ++a) {
    SparseRows::InnerIterator it(problem.U.sparse(), a);
    if (!it || !(it.value() > 0)) return std::nullopt;
    double& lower = grid.lower[grid.A.at(it.col() % width, it.col() / width)];
    if (lower > none) return std::nullopt;
    lower = problem.s[a] / it.value();
    if (lower * it.value() != problem.s[a]) return std::nullopt;
    ++it;
    if (it) return std::nullopt;
  }
  return grid;
}

GridProblem coarse_problem(const GridProblem& fine_grid) {
  GridProblem coarse{coarsened(fine_grid.A), {}, {}};
  coarse.z = coarse.A.field();
  restrict_to(fine_grid.A, fine_grid.z, coarse.A, coarse.z);
  coarse.lower = Vector::Constant(coarse.A.size(), none);
  for (Index j = 0; j < coarse.A.height; ++j)
    for (Index i = 0; i < coarse.A.width; ++i)
      coarse.lower[coarse.A.at(i, j)] = fine_grid.lower[fine_grid.A.at(2 * i + 1, 2 * j + 1)];
  return coarse;
}

/// z - A q on all points, q = hi + lo, in twice the working precision.
void rest_of(const GridProblem& grid, const DoubleDoubleVector& q, Vector& rest) {
  const GridOperator& A = grid.A;
  const Index stride = A.stride();
  for (Index j = 0; j < A.height; ++j)
    for (Index k = A.at(0, j); k < A.at(A.width, j); ++k) {
      DoubleDouble around = add(add(q[k - 1], q[k + 1]), add(q[k - stride], q[k + stride]));
      DoubleDouble beside = two_product(A.c, around.hi), centre = two_product(-A.d, q.hi[k]);
      beside.lo += A.c * around.lo;
      centre.lo -= A.d * q.lo[k];
      rest[k] = add({grid.z[k], 0}, add(beside, centre)).value();
    }
}

struct GridPoint {
  DoubleDoubleVector q;
  Vector rest;
  double missing = 0;
  Index steps = 0, sets = 0;
  bool ended = false;
};

/// The active set of (q, z - Aq): points whose multiplier outweighs their height.
Vector free_points(const GridProblem& grid, const GridPoint& point) {
  Vector free = grid.A.field();
  for (Index j = 0; j < grid.A.height; ++j)
    for (Index k = grid.A.at(0, j); k < grid.A.at(grid.A.width, j); ++k) {
      const bool active = -point.rest[k] + grid.A.d * (grid.lower[k] - point.q.hi[k]) > 0;
      free[k] = active ? 0 : 1;
    }
  return free;
}

void hold(const GridProblem& grid, const Vector& free, GridPoint& point) {
  for (Index k = 0; k < free.size(); ++k)
    if (!(free[k] > 0)) {
      point.q.hi[k] = grid.lower[k] > none ? grid.lower[k] : 0;
      point.q.lo[k] = 0;
    }
}

/// From the answer on the next coarser grid; refined to all digits when `sharp`.
GridPoint solve_grid(const GridProblem& grid, bool sharp) {
  constexpr Index coarsest = 8;
  GridPoint point{DoubleDoubleVector(grid.A.size()), grid.A.field()};
  if (std::min(grid.A.width, grid.A.height) >= 2 * coarsest) {
    const GridProblem coarse = coarse_problem(grid);
    const GridPoint start = solve_grid(coarse, false);
    point.steps = start.steps;
    interpolate(coarse.A, start.q.hi, grid.A, point.q.hi);
  }
  for (Index k = 0; k < grid.A.size(); ++k) point.q.hi[k] = std::max(point.q.hi[k], grid.lower[k]);
  for (Index i = 0; i < grid.A.width + 2; ++i) point.q.hi[i] = point.q.hi[grid.A.size() - 1 - i] = 0;
  for (Index j = -1; j <= grid.A.height; ++j)
    point.q.hi[grid.A.at(-1, j)] = point.q.hi[grid.A.at(grid.A.width, j)] = 0;

  GridMultigrid multigrid(grid.A);
  Vector correction, free = grid.A.field();
  for (int k = 0; k < most_sets && !point.ended; ++k) {
    rest_of(grid, point.q, point.rest);
    const Vector next = free_points(grid, point);
    point.ended = k > 0 && next == free;
    free = next;
    ++point.sets;
    multigrid.set_free(free);
    hold(grid, free, point);
    double previous = 0, contraction = 1;
    const int corrections = sharp && point.ended ? most_refinements : 1;
    for (int j = 0; j < corrections; ++j) {
      rest_of(grid, point.q, point.rest);
      const double size = multigrid.solve(point.rest, sharp && point.ended ? fine : rough, correction);
      point.q.add(correction);
      contraction = j > 0 && previous > 0 ? std::max(fine, size / previous) : 1;
      previous = size;
      point.missing = contraction < 1 ? size * contraction / (1 - contraction) : size;
      const double scale = std::sqrt(std::abs(point.q.hi.dot(grid.z)));
      if (j > 0 && (point.missing <= enough * scale || contraction > 0.5)) break;
    }
    if (sharp && point.ended) {
      rest_of(grid, point.q, point.rest);
      const double height = point.q.hi.cwiseAbs().maxCoeff(), noise = 0x1p-80 * (grid.A.d * height);
      for (Index i = 0; i < free.size(); ++i)
        if (!(free[i] > 0) && std::abs(point.rest[i]) <= noise) point.rest[i] = 0;
      // With all digits the set is to be the same; points within what is missing of their bound lie on it.
      Vector again = free;
      for (Index j = 0; j < grid.A.height; ++j)
        for (Index i = grid.A.at(0, j); i < grid.A.at(grid.A.width, j); ++i) {
          if (free[i] > 0 && point.q.hi[i] - grid.lower[i] < -4 * point.missing) again[i] = 0;
          if (!(free[i] > 0) && point.rest[i] > 0) again[i] = 1;
        }
      point.ended = again == free;
    }
  }
  point.steps += multigrid.steps();
  return point;
}

}  // namespace

std::optional<Solution> solve_obstacle(const NearestPointProblem& problem, const Accuracy& accuracy) {
  const std::optional<GridProblem> grid = grid_problem(problem);
  if (!grid) return std::nullopt;
  const GridPoint point = solve_grid(*grid, true);
  if (!point.ended) return std::nullopt;
  const Index n = problem.dimension(), width = grid->A.width;
  const auto place = [&](Index k) { return grid->A.at(k % width, k / width); };
  Solution found;
  found.method = "obstacle";
  found.q.resize(n);
  Vector lost(n);
  for (Index k = 0; k < n; ++k) {
    found.q[k] = point.q.hi[place(k)];
    lost[k] = point.q.lo[place(k)];
  }
  found.lambda = Vector::Zero(problem.rows());
  found.slack = Vector::Zero(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a) {
    const SparseRows::InnerIterator it(problem.U.sparse(), a);
    const Index k = place(it.col());
    if (point.q.hi[k] <= grid->lower[k]) {
      found.lambda[a] = std::max(0.0, -point.rest[k] / it.value());
      found.basis.push_back(a);
    } else {
      found.slack[a] = problem.U.sparse().row(a).dot(found.q) - problem.s[a];
    }
  }
  found.steps = point.steps;
  found.acceleration_norm = std::sqrt(std::max(0.0, found.q.dot(problem.A.multiply(found.q))));
  found.force_norm = problem.A.dual_norm(problem.z);
  found.residuals = residuals(
      problem, found.q, found.lambda,
      KnownParts{Vector::Zero(problem.rows()), found.slack, {}, found.acceleration_norm, found.force_norm});
  found.rounding = std::sqrt(2 * grid->A.d * lost.squaredNorm());
  found.error_bound = 2 * point.missing + found.rounding;
  const bool close = found.error_bound <= accuracy.tolerance * std::max(1.0, found.acceleration_norm);
  found.status = close ? Status::solved : Status::inaccurate;
  found.model.islands = {{found.method, n, problem.rows(), 0, 60.0 * static_cast<double>(point.steps * n),
                          6.0 * static_cast<double>(n)}};
  return found;
}

}  // namespace convex
