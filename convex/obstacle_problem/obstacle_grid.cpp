#include "convex/obstacle_problem/obstacle_grid.hpp"

#include <cmath>
#include <limits>

#include "convex/obstacle_problem/grid_kernels.hpp"
#include "convex/obstacle_problem/grid_transfer.hpp"

namespace convex::inline obstacle_problem {
namespace {

/// Active sets tried on one grid.
constexpr int most_sets = 160, most_refinements = 12;
/// Projected sweeps before a set is chosen.
constexpr int sweeps = 2;
/// What may be missing at the end, relative to the scale.
constexpr double enough = 0x1p-58;

class GridSolver {
 public:
  GridSolver(const ObstacleGrid& grid, GridMultigrid& multigrid, const std::function<void(Index)>& told,
             bool sharp)
      : grid_(grid),
        A_(grid.A),
        sharp_(sharp),
        multigrid_(multigrid),
        told_(told),
        z_(grid.z),
        free_(A_.field()) {
    point_.q = DoubleDoubleVector(A_.size());
    point_.rest = A_.field();
    for (Vector* colour : {&even_, &odd_}) *colour = Vector::Zero(A_.width + 1);
    for (Index i = 0; i <= A_.width; ++i) (i % 2 == 0 ? even_ : odd_)[i] = 1;
  }

  ObstaclePoint solve() {
    start();
    for (int k = 0; k < most_sets && !point_.ended; ++k) {
      project();
      residual();
      const Index changed = choose();
      if (k > 0 && changed == 0) {
        point_.ended = !sharp_ || refine();
        if (point_.ended) break;
      }
      multigrid_.set_free(free_);
      hold();
      residual();
      multigrid_.solve(point_.rest, rough_part, correction_);
      point_.q.hi += correction_;
      told_(point_.steps + multigrid_.steps());
    }
    point_.steps += multigrid_.steps();
    return std::move(point_);
  }

 private:
  void start() {
    constexpr Index coarsest = 8;
    if (std::min(A_.width, A_.height) >= 2 * coarsest) {
      ObstacleGrid coarse{coarsened(A_), {}, {}, {}};
      coarse.z = coarse.A.field();
      restrict_to(A_, grid_.z, coarse.A, coarse.z);
      coarse.lower = Vector::Constant(coarse.A.size(), no_bound);
      if (grid_.held.size() > 0) coarse.held = coarse.A.field();
      for (Index j = 0; j < coarse.A.height; ++j)
        for (Index i = 0; i < coarse.A.width; ++i) {
          const Index here = coarse.A.at(i, j), there = A_.at(2 * i + 1, 2 * j + 1);
          coarse.lower[here] = grid_.lower[there];
          if (grid_.holds(there)) coarse.held[here] = 1;
        }
      GridMultigrid coarse_multigrid(coarse.A);
      const ObstaclePoint below = GridSolver(coarse, coarse_multigrid, told_, false).solve();
      point_.steps = below.steps;
      interpolate(coarse.A, below.q.hi, A_, point_.q.hi);
    }
    for_rows([&](Index k) {
      for (Index i = k; i < k + A_.width; ++i)
        point_.q.hi[i] = grid_.holds(i) ? grid_.lower[i] : std::max(point_.q.hi[i], grid_.lower[i]);
    });
  }

  template <class Visit>
  void for_rows(Visit visit) const {
    for (Index j = 0; j < A_.height; ++j) visit(A_.at(0, j));
  }

  /// Projected red-black sweeps, black one row behind.
  void project() {
    for (int k = 0; k < sweeps; ++k)
      for (Index j = 0; j <= A_.height; ++j) {
        if (j < A_.height) project_row(j, j % 2);
        if (j > 0) project_row(j - 1, j % 2);
      }
  }
  void project_row(Index j, Index first) {
    const Index k = A_.at(0, j);
    grid_kernels::relax_above(A_.width, A_.stride(), A_.c, 1 / A_.d, (first == 0 ? even_ : odd_).data(),
                              grid_.lower.data() + k, grid_.z.data() + k, point_.q.hi.data() + k);
    for (Index i = k; i < k + A_.width && grid_.held.size() > 0; ++i)
      if (grid_.holds(i)) point_.q.hi[i] = grid_.lower[i];
  }

  void residual() {
    for_rows([&](Index k) {
      grid_kernels::residual(A_.width, A_.stride(), A_.d, A_.c, grid_.z.data() + k, point_.q.hi.data() + k,
                             point_.rest.data() + k);
    });
  }

  /// Points are free unless their multiplier outweighs their height; how many changed.
  Index choose() {
    double changed = 0;
    for_rows([&](Index row) {
      for (Index k = row; k < row + A_.width && grid_.held.size() > 0; ++k)
        if (grid_.holds(k)) point_.rest[k] = no_bound;
      changed += grid_kernels::choose(A_.width, A_.d, grid_.lower.data() + row, point_.q.hi.data() + row,
                                      point_.rest.data() + row, free_.data() + row);
    });
    return static_cast<Index>(changed);
  }

  void hold() {
    for_rows([&](Index row) {
      for (Index k = row; k < row + A_.width; ++k)
        if (!(free_[k] > 0)) {
          point_.q.hi[k] = grid_.lower[k];
          point_.q.lo[k] = 0;
        }
    });
  }

  /// All digits on the points that are free; whether these are then the right ones.
  bool refine() {
    hold();
    const double scale = std::sqrt(std::abs(point_.q.hi.dot(grid_.z)));
    for (int j = 0; j < most_refinements; ++j) {
      precise_residual(A_, z_, point_.q, point_.rest);
      const GridMultigrid::Size size =
          multigrid_.solve(point_.rest, fine_part, correction_, enough / 4 * scale);
      point_.q.add(correction_);
      point_.missing = 2 * size.missing;
      if (point_.missing <= enough * scale) break;
    }
    precise_residual(A_, z_, point_.q, point_.rest);
    const double height = point_.q.hi.cwiseAbs().maxCoeff(), noise = 0x1p-80 * (A_.d * height);
    Index wrong = 0;
    // Points within what is missing of their bound lie on it.
    for_rows([&](Index row) {
      for (Index k = row; k < row + A_.width; ++k) {
        double& rest = point_.rest[k];
        if (!(free_[k] > 0)) {
          if (std::abs(rest) <= noise) rest = 0;
          if (rest > 0 && !grid_.holds(k)) free_[k] = 1, ++wrong;
        } else if (point_.q.hi[k] - grid_.lower[k] < -4 * point_.missing) {
          free_[k] = 0;
          ++wrong;
        }
      }
    });
    return wrong == 0;
  }

  const ObstacleGrid& grid_;
  const GridOperator& A_;
  const bool sharp_;
  /// The part of a residual left while sets are sought, a V-cycle's, and in a refinement.
  static constexpr double rough_part = 1, fine_part = 1e-4;
  GridMultigrid& multigrid_;
  const std::function<void(Index)>& told_;
  ObstaclePoint point_;
  const DoubleDoubleVector z_;
  Vector free_, correction_, even_, odd_;
};

}  // namespace

void precise_residual(const GridOperator& A, const DoubleDoubleVector& z, const DoubleDoubleVector& u,
                      Vector& rest) {
  for (Index j = 0; j < A.height; ++j) {
    const Index k = A.at(0, j);
    grid_kernels::precise_residual(A.width, A.stride(), A.d, A.c, z.hi.data() + k, z.lo.data() + k,
                                   u.hi.data() + k, u.lo.data() + k, rest.data() + k);
  }
}

ObstaclePoint solve_obstacle_grid(const ObstacleGrid& grid, GridMultigrid& multigrid,
                                  const std::function<void(Index)>& told) {
  return GridSolver(grid, multigrid, told, true).solve();
}

}  // namespace convex::inline obstacle_problem
