#include "convex/obstacle_problem/grid_multigrid.hpp"

#include <algorithm>
#include <cmath>

#include "convex/obstacle_problem/grid_kernels.hpp"
#include "convex/obstacle_problem/row_kernels.hpp"

namespace convex::inline obstacle_problem {
namespace {

constexpr Index smallest_grid = 3;
/// Sweeps in each direction that solve the coarsest grid well enough.
constexpr int coarsest_sweeps = 12;

}  // namespace

GridOperator coarsened(const GridOperator& fine) {
  return {fine.width / 2, fine.height / 2, 4 * fine.c + 4 * (fine.d - 4 * fine.c), fine.c};
}

GridMultigrid::Level GridMultigrid::level(const GridOperator& A, bool is_finest) {
  Level made{A.width, A.height, 1, static_cast<float>(A.d / A.c), {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  const auto size = static_cast<std::size_t>(A.size()), row = static_cast<std::size_t>(A.stride());
  made.d.assign(is_finest ? row : size, made.free_d);
  made.inverse_d.assign(made.d.size(), 1 / made.free_d);
  if (!is_finest) made.edges.assign(size, {1, 1, 1, 1});
  for (std::vector<float>* field : {&made.free, &made.u, &made.r}) field->assign(size, 0);
  for (std::vector<float>* one : {&made.even, &made.odd, &made.mean, &made.sum, &made.last})
    one->assign(row, 0);
  for (std::size_t i = 0; i < row; ++i) (i % 2 == 1 ? made.even : made.odd)[i] = 1;  // entry i is point i - 1
  return made;
}

GridMultigrid::GridMultigrid(const GridOperator& finest) : finest_(finest) {
  GridOperator grid = finest;
  levels_.push_back(level(grid, true));
  while (std::min(grid.width, grid.height) > smallest_grid) {
    grid = coarsened(grid);
    levels_.push_back(level(grid, false));
  }
}

void GridMultigrid::set_free(const Vector& free) {
  for (Index k = 0; k < free.size(); ++k)
    levels_.front().free[static_cast<std::size_t>(k)] = static_cast<float>(free[k]);
  for (std::size_t l = 1; l < levels_.size(); ++l) set_coarse(levels_[l - 1], levels_[l]);
}

void GridMultigrid::set_coarse(const Level& fine, Level& coarse) {
  for (Index j = 0; j < coarse.height; ++j) {
    const float* from = fine.free.data() + fine.at(2 * j + 1) + 1;
    float* to = coarse.free.data() + coarse.at(j);
    for (Index i = 0; i < coarse.width; ++i) to[i] = from[2 * i];
  }
  const std::array<Index, 4> beside{-1, 1, -fine.stride(), fine.stride()},
      coarse_beside{-1, 1, -coarse.stride(), coarse.stride()};
  const auto place = [](Index k) { return static_cast<std::size_t>(k); };
  for (Index j = 0; j < coarse.height; ++j)
    for (Index i = 0; i < coarse.width; ++i) {
      const Index k = coarse.at(j) + i, there = fine.at(2 * j + 1) + 2 * i + 1;
      float d = coarse.free_d;
      for (std::size_t side = 0; side < 4; ++side) {
        const Index between = there + beside[side];
        float& edge = coarse.edges[place(k)][side];
        edge = 1;
        if (!(fine.free[place(between)] > 0))
          edge = (fine.edges.empty() ? 1 : fine.edges[place(there)][side]) / 2;
        else if (!(coarse.free[place(k + coarse_beside[side])] > 0))
          edge = (1 + (fine.edges.empty() ? 1 : fine.edges[place(between)][side])) / 2;
        d += 1 / edge - 1;
      }
      coarse.d[place(k)] = d;
      coarse.inverse_d[place(k)] = 1 / d;
    }
}

/// One colour of a row relaxed; colours of points beside differ, so the order within a row is no matter.
void GridMultigrid::sweep_row(Level& grid, Index j, bool red) {
  grid_kernels::relax(grid.width, grid.stride(), grid.c, grid.of_row(grid.inverse_d, j), grid.colour(j, red),
                      grid.free.data() + grid.at(j), grid.r.data() + grid.at(j), grid.u.data() + grid.at(j));
}

/// A red-black sweep from 0 on the fine grid, and what it leaves, restricted.
void GridMultigrid::descend(Level& fine, Level& coarse) {
  const Index n = fine.width;
  const auto first = [&](Index j) {
    grid_kernels::relax_zero(n, fine.of_row(fine.inverse_d, j), fine.colour(j, true),
                             fine.free.data() + fine.at(j), fine.r.data() + fine.at(j),
                             fine.u.data() + fine.at(j));
  };
  // `row` gathers the residuals of three rows, the outer two by half, `mean` those of the last one.
  const auto residual = [&](Index j, float weight, const std::vector<float>& before,
                            std::vector<float>& into) {
    grid_kernels::add_residual(n, fine.stride(), fine.of_row(fine.d, j), fine.c,
                               fine.free.data() + fine.at(j), fine.r.data() + fine.at(j),
                               fine.u.data() + fine.at(j), weight, before.data() + 1, into.data() + 1);
  };
  std::vector<float>&sum = fine.sum, &last = fine.last, &nothing = fine.mean;
  std::fill(nothing.begin(), nothing.end(), 0.0F);
  first(0);
  Index relaxed = 0;  // rows relaxed in both colours
  const auto relax_to = [&](Index end) {
    for (; relaxed < std::min(end, fine.height); ++relaxed) {
      if (relaxed + 1 < fine.height) first(relaxed + 1);
      sweep_row(fine, relaxed, false);
    }
  };
  relax_to(2);
  residual(0, 0.5F, nothing, last);
  for (Index j = 0; j < coarse.height; ++j) {
    relax_to(2 * j + 4);
    residual(2 * j + 1, 1, last, sum);
    std::fill(last.begin(), last.end(), 0.0F);
    if (2 * j + 2 < fine.height) residual(2 * j + 2, 0.5F, nothing, last);
    for (Index i = 0; i < n; ++i)
      sum[static_cast<std::size_t>(i + 1)] += last[static_cast<std::size_t>(i + 1)];
    grid_kernels::gather(coarse.width, sum.data() + 1, coarse.free.data() + coarse.at(j),
                         coarse.r.data() + coarse.at(j));
  }
  relax_to(fine.height);
}

/// The correction interpolated, and a black-red sweep, each row as soon as those beside it are ready;
/// row_done(j) hears of rows that are through.
template <class RowDone>
void GridMultigrid::ascend(const Level& coarse, Level& fine, RowDone row_done) {
  const float* e = coarse.u.data();
  for (Index j = 0; j < fine.height + 2; ++j) {
    if (j < fine.height) {
      // Fine row 2k + 1 lies on coarse row k, 2k between k - 1 and k.
      const Index below = j / 2 - 1 + j % 2, above = std::min(j / 2, coarse.height);
      grid_kernels::spread(fine.width, coarse.width, e + coarse.at(below), e + coarse.at(above),
                           fine.free.data() + fine.at(j), fine.mean.data() + 1, fine.u.data() + fine.at(j));
    }
    if (j >= 1 && j - 1 < fine.height) sweep_row(fine, j - 1, false);
    if (j < 2) continue;
    sweep_row(fine, j - 2, true);
    if (j >= 3) row_done(j - 3);
  }
  row_done(fine.height - 1);
}

template <class RowDone>
void GridMultigrid::cycle(std::size_t level, RowDone row_done) {
  Level& grid = levels_[level];
  if (level + 1 == levels_.size()) {
    std::fill(grid.u.begin(), grid.u.end(), 0.0F);
    for (int k = 0; k < 2 * coarsest_sweeps; ++k)
      for (const bool red : {k < coarsest_sweeps, k >= coarsest_sweeps})
        for (Index j = 0; j < grid.height; ++j) sweep_row(grid, j, red);
    for (Index j = 0; j < grid.height; ++j) row_done(j);
    return;
  }
  descend(grid, levels_[level + 1]);
  cycle(level + 1, Unheard{});
  ascend(levels_[level + 1], grid, row_done);
}

GridMultigrid::Size GridMultigrid::solve(const Vector& right, double part, Vector& u, double absolute) {
  Level& grid = levels_.front();
  const Index size = finest_.size(), n = grid.width;
  double square = 0;
  for (Index j = 0; j < grid.height; ++j)
    square += grid_kernels::free_square(n, grid.free.data() + grid.at(j), right.data() + grid.at(j));
  u.resize(size);
  constexpr Index most_steps = 200;
  constexpr double least = 0x1p-900, so_little = 0x1p-400;  // squares below are no ordinary doubles
  if (!(square >= least)) {
    bool is_zero = true;
    for (Index j = 0; j < grid.height; ++j)
      for (Index k = grid.at(j); k < grid.at(j) + n; ++k)
        is_zero = is_zero && !(grid.free[static_cast<std::size_t>(k)] > 0 && right[k] != 0);
    u.setZero();
    return is_zero ? Size{0, 0} : Size{so_little, so_little};
  }
  // Numbers of size 1, and c = 1: of A/c x = r, r scaled, energies are those of A u = r over unit²/c.
  const double unit = std::sqrt(square / static_cast<double>(n * grid.height));
  // What they have of a solve before, but for their frames of 0, is written over.
  for (std::vector<float>* field : {&p_, &Ap_}) field->resize(static_cast<std::size_t>(size));
  x_.assign(static_cast<std::size_t>(size), 0);
  // Beside tiny entries on the free points those elsewhere may be beyond all floats.
  grid_kernels::take_free(size, grid.free.data(), right.data(), 1 / unit, grid.r.data());
  const double energy_unit = unit * unit / finest_.c;
  double energy = 0, previous = 0, step = 0;
  for (Index count = 0; count < most_steps; ++count) {
    grid_kernels::Products with;
    cycle(0, [&](Index j) {
      const Index k = grid.at(j);
      grid_kernels::add_products(n, grid.r.data() + k, Ap_.data() + k, grid.u.data() + k, with);
    });
    const double beta = count == 0 ? 0 : -step * with.of_Ap / previous;
    double curvature = 0;
    for (Index j = -1; j < grid.height; ++j) {  // a row is turned before the one below it is applied
      const Index next = grid.at(j + 1);
      if (j + 1 < grid.height && count == 0) std::copy_n(grid.u.data() + next, n, p_.data() + next);
      if (j + 1 < grid.height && count > 0)
        row_kernels::turn(n, static_cast<float>(beta), grid.u.data() + next, p_.data() + next);
      if (j < 0) continue;
      const Index k = grid.at(j);
      curvature += grid_kernels::apply(n, grid.stride(), grid.of_row(grid.d, j), grid.c, grid.free.data() + k,
                                       p_.data() + k, Ap_.data() + k);
    }
    if (!(curvature > 0) || !(with.of_r > 0)) break;
    step = with.of_r / curvature;  // r·p = r·z, for r is at right angles to the direction before
    row_kernels::advance(size, static_cast<float>(step), p_.data(), Ap_.data(), x_.data(), grid.r.data());
    energy += step * with.of_r;
    previous = with.of_r;
    ++steps_;
    if (previous <= std::max(part * part * energy, absolute * absolute / energy_unit)) break;
  }
  const double back = unit / finest_.c;
  for (Index k = 0; k < size; ++k) u[k] = back * static_cast<double>(x_[static_cast<std::size_t>(k)]);
  const double root = unit / std::sqrt(finest_.c);  // squares of tiny numbers are 0
  return {std::sqrt(energy) * root, std::sqrt(previous) * root};
}

}  // namespace convex::inline obstacle_problem
