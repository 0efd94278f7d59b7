#include "convex/nearest_point/obstacle/obstacle.hpp"

#include <cmath>
#include <limits>

#include "convex/exact/exact_sum.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/solve_watch.hpp"
#include "convex/obstacle_problem/grid_kernels.hpp"
#include "convex/obstacle_problem/obstacle_grid.hpp"

namespace convex::inline obstacle {
namespace {

Vector all_points(const GridOperator& A) {
  Vector all = A.field();
  for (Index j = 0; j < A.height; ++j) all.segment(A.at(0, j), A.width).setOnes();
  return all;
}

Vector on_grid(const GridOperator& A, const Vector& x) {
  Vector field = A.field();
  for (Index j = 0; j < A.height; ++j) field.segment(A.at(0, j), A.width) = x.segment(j * A.width, A.width);
  return field;
}

Vector off_grid(const GridOperator& A, const Vector& field) {
  Vector x(A.width * A.height);
  for (Index j = 0; j < A.height; ++j) x.segment(j * A.width, A.width) = field.segment(A.at(0, j), A.width);
  return x;
}

/// The place of a point in a field; those that follow each other are found without a division.
class GridPlace {
 public:
  explicit GridPlace(const GridOperator& A) : A_(A) {}
  Index operator()(Index k) {
    if (k < first_ || k >= first_ + A_.width) {
      row_ = k == first_ + A_.width ? row_ + 1 : k / A_.width;
      first_ = row_ * A_.width;
    }
    return A_.at(k - first_, row_);
  }

 private:
  const GridOperator& A_;
  Index row_ = 0, first_ = 0;
};

/// Whether W, compressed, is the operator of the grid: by columns, in order, -c beside each point and d on
/// it.
bool has_entries_of(const GridOperator& A, const SparseMatrix& W) {
  const Index n = W.rows();
  const auto* rows = W.innerIndexPtr();
  const double* values = W.valuePtr();
  for (Index k = 0, i = 0, next = 0; k < n; ++k, i = i + 1 < A.width ? i + 1 : 0) {
    const auto is_next = [&](Index row, double value) {
      const bool is = rows[next] == row && values[next] == value;
      ++next;
      return is;
    };
    const Index entries = 1 + (k >= A.width) + (i > 0) + (i + 1 < A.width) + (k + A.width < n);
    if (W.outerIndexPtr()[k + 1] != next + entries) return false;
    if (k >= A.width && !is_next(k - A.width, -A.c)) return false;
    if (i > 0 && !is_next(k - 1, -A.c)) return false;
    if (!is_next(k, A.d)) return false;
    if (i + 1 < A.width && !is_next(k + 1, -A.c)) return false;
    if (k + A.width < n && !is_next(k + A.width, -A.c)) return false;
  }
  return true;
}

std::optional<ObstacleGrid> grid_problem(const NearestPointProblem& problem) {
  constexpr Index smallest = 8;
  if (problem.A.kind() != MetricKind::sparse || !problem.U.is_sparse()) return std::nullopt;
  const SparseMatrix& W = problem.A.sparse_gram();
  const Index n = W.rows();
  SparseMatrix::InnerIterator first(W, 0);
  if (!first || first.row() != 0) return std::nullopt;
  ObstacleGrid grid;
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
  if (!has_entries_of(grid.A, W)) return std::nullopt;
  grid.z = on_grid(grid.A, problem.z);
  grid.lower = Vector::Constant(grid.A.size(), no_bound);
  if (!problem.two_sided.empty()) grid.held = grid.A.field();
  auto next_two_sided = problem.two_sided.begin();
  GridPlace place(grid.A);
  for (Index a = 0; a < problem.rows(); ++a) {
    SparseRows::InnerIterator it(problem.U.sparse(), a);
    if (!it || !(it.value() > 0)) return std::nullopt;
    const Index point = place(it.col());
    if (next_two_sided != problem.two_sided.end() && *next_two_sided == a) {
      grid.held[point] = 1;
      ++next_two_sided;
    }
    double& lower = grid.lower[point];
    if (lower > no_bound) return std::nullopt;
    lower = problem.s[a] / it.value();
    if (lower * it.value() != problem.s[a]) return std::nullopt;
    ++it;
    if (it) return std::nullopt;
  }
  return grid;
}

/// Decides which free points touch their bound where what is missing in q could hide that: points tied to
/// each other through free ones, and kept from the rest by points held, are put on their bounds where these
/// are close and verified without rounding. False when that does not verify.
class DegeneratePoints {
 public:
  DegeneratePoints(const ObstacleGrid& grid, ObstaclePoint& point) : grid_(grid), A_(grid.A), point_(point) {
    // |e_k| <= ||e||_A / sqrt(least eigenvalue of A), which is that of the whole rectangle.
    const double pi = std::acos(-1.0);
    const auto bend = [&](Index points) { return std::cos(pi / static_cast<double>(points + 1)); };
    const double least = A_.d - 2 * A_.c * (bend(A_.width) + bend(A_.height));
    reach_ = 4 * point.missing / std::sqrt(std::max(least, 0x1p-40 * A_.d));
  }

  bool decide() {
    std::vector<Index> close;
    for (Index j = 0; j < A_.height; ++j)
      for (Index k = A_.at(0, j); k < A_.at(0, j) + A_.width; ++k) {
        const double height = point_.q.hi[k] - grid_.lower[k];
        if (height > 0 && height <= reach_ && is_free(k)) close.push_back(k);
      }
    if (close.empty()) return true;
    seen_.assign(static_cast<std::size_t>(A_.size()), true);
    for (Index j = 0; j < A_.height; ++j)
      for (Index k = A_.at(0, j); k < A_.at(0, j) + A_.width; ++k) seen_[at(k)] = !is_free(k);
    std::vector<Index> tied;
    for (Index k : close) gather(k, tied);
    for (Index k : close) put(k, grid_.lower[k]);
    for (Index k : tied) {
      if (point_.q.lo[k] != 0) return false;
      const int sign = rest(k).sign();
      const bool on_bound = point_.q.hi[k] <= grid_.lower[k];
      if (on_bound ? sign > 0 : sign != 0) return false;
    }
    for (Index k : tied) point_.rest[k] = rest(k).value();
    return true;
  }

 private:
  bool is_free(Index k) const { return !grid_.holds(k) && point_.q.hi[k] > grid_.lower[k]; }
  void put(Index k, double height) {
    point_.q.hi[k] = height;
    point_.q.lo[k] = 0;
  }
  void gather(Index first, std::vector<Index>& tied) {
    const std::size_t begin = tied.size();
    const auto meet = [&](Index k) {
      if (seen_[at(k)]) return;
      seen_[at(k)] = true;
      tied.push_back(k);
    };
    meet(first);
    for (std::size_t next = begin; next < tied.size(); ++next)
      for (Index by : {Index{1}, A_.stride()}) {
        meet(tied[next] - by);
        meet(tied[next] + by);
      }
  }
  /// z - Aq at a point.
  ExactSum rest(Index k) const {
    ExactSum sum;
    sum.add(grid_.z[k]);
    sum.add_product(-A_.d, point_.q.hi[k]);
    for (Index by : {Index{1}, A_.stride()}) {
      sum.add_product(A_.c, point_.q.hi[k - by]);
      sum.add_product(A_.c, point_.q.hi[k + by]);
    }
    return sum;
  }

  const ObstacleGrid& grid_;
  const GridOperator& A_;
  ObstaclePoint& point_;
  std::vector<bool> seen_;
  double reach_ = 0;
};

/// ||u||_A of a field: no term is negative, so none cancels.
double grid_norm(const GridOperator& A, const Vector& u) {
  double energy = 0;
  for (Index j = 0; j <= A.height; ++j)  // the frame has links too
    energy += grid_kernels::energy(A.width + 1, A.stride(), A.d, A.c, u.data() + A.at(0, j));
  return std::sqrt(energy);
}

/// ||c||_(A⁻¹) of fields without a factor of A.
class GridNorm {
 public:
  GridNorm(const GridOperator& A, GridMultigrid& multigrid) : A_(A), multigrid_(multigrid) {
    multigrid_.set_free(all_points(A));
  }

  /// To the square of `close`: with Au near c and r = c - Au, the square is u·c + u·r + ||r||².
  double dual(const Vector& c) {
    constexpr double close = 1e-4;
    Vector u, r = A_.field();
    const double missing = multigrid_.solve(c, close, u).missing;
    for (Index j = 0; j < A_.height; ++j) {
      const Index k = A_.at(0, j);
      grid_kernels::residual(A_.width, A_.stride(), A_.d, A_.c, c.data() + k, u.data() + k, r.data() + k);
    }
    return std::sqrt(std::max(0.0, u.dot(c) + u.dot(r) + missing * missing));
  }
  /// To a hundredth: what is found lacks the square of the part left.
  double rough_dual(const Vector& c) {
    constexpr double close = 0.1;
    Vector u;
    return multigrid_.solve(c, close, u).found;
  }

 private:
  const GridOperator& A_;
  GridMultigrid& multigrid_;
};

}  // namespace

std::optional<Solution> solve_obstacle(const NearestPointProblem& problem, const Accuracy& accuracy) {
  const std::optional<ObstacleGrid> grid = grid_problem(problem);
  if (!grid) return std::nullopt;
  GridMultigrid multigrid(grid->A);
  ObstaclePoint point =
      solve_obstacle_grid(*grid, multigrid, [](Index steps) { SolveWatch::tell("obstacle", steps); });
  if (!point.ended) return std::nullopt;
  const bool decided = DegeneratePoints(*grid, point).decide();
  const Index n = problem.dimension();
  GridPlace place(grid->A);
  Solution found;
  found.method = "obstacle";
  found.q = off_grid(grid->A, point.q.hi);
  found.lambda = Vector::Zero(problem.rows());
  found.slack = Vector::Zero(problem.rows());
  DoubleDoubleVector pushed(grid->z);  // z + Uᵀlambda
  Vector length(problem.rows()), magnitude(problem.rows());
  const double root = std::sqrt(grid->A.d);
  for (Index a = 0; a < problem.rows(); ++a) {
    const SparseRows::InnerIterator it(problem.U.sparse(), a);
    length[a] = it.value() / root;  // a lower bound, (u·v)/||v||_A with v = u, is enough
    const Index k = place(it.col());
    const double height = it.value() * point.q.hi[k];
    magnitude[a] = std::abs(height);
    if (grid->holds(k) || point.q.hi[k] <= grid->lower[k]) {
      const double push = -point.rest[k] / it.value();
      found.lambda[a] = grid->holds(k) ? push : std::max(0.0, push);
      accumulate_product(it.value(), {found.lambda[a], 0}, pushed.hi[k], pushed.lo[k]);
      found.basis.push_back(a);
    } else {
      found.slack[a] = height - problem.s[a];
    }
  }
  found.steps = point.steps;
  found.acceleration_norm = grid_norm(grid->A, point.q.hi);
  GridNorm norm(grid->A, multigrid);
  found.force_norm = norm.dual(grid->z);
  precise_residual(grid->A, pushed, DoubleDoubleVector(point.q.hi), point.rest);
  const double unbalanced = norm.rough_dual(point.rest);
  found.residuals =
      residuals(problem, found,
                {.length = std::move(length), .magnitude = std::move(magnitude), .stationarity = unbalanced});
  found.rounding = std::sqrt(2 * grid->A.d * point.q.lo.squaredNorm());
  found.error_bound = 2 * point.missing + found.rounding;
  found.status = found.is_within(accuracy) && decided ? Status::solved : Status::inaccurate;
  if (!decided) found.undecided = open_question::degenerate_rows;
  found.model.islands = {{found.method, n, problem.rows(), 0, 60.0 * static_cast<double>(point.steps * n),
                          6.0 * static_cast<double>(n)}};
  return found;
}

}  // namespace convex::inline obstacle
