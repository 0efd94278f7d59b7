#include "convex/obstacle_problem/cut_multigrid.hpp"

#include <algorithm>
#include <cmath>

#include "convex/obstacle_problem/cut_rows.hpp"
#include "convex/obstacle_problem/row_kernels.hpp"

namespace convex::inline obstacle_problem {
namespace {

constexpr Index most_steps = 200, most_steps_of_round = 40;
/// What floats bring a residual down to before it is found anew in doubles, and what a round that gets
/// anywhere leaves at most.
constexpr double float_part = 1e-4, stuck_part = 0.3;

/// The coarse rows around a fine row.
struct RowsAround {
  std::array<Index, 4> first{};
  std::size_t count = 0;
};
RowsAround coarse_rows(const CutGrid& coarse, Index j, Index k) {
  RowsAround rows;
  for (Index b = k / 2; b <= (k + 1) / 2; ++b)
    for (Index a = j / 2; a <= (j + 1) / 2; ++a) rows.first[rows.count++] = coarse.at(0, a, b);
  return rows;
}

/// One row of coarse values, averaged over the coarse rows around a fine row, spread to it.
template <class Number>
void spread_row(const CutGrid& coarse, const Number* from, const RowsAround& rows, Number* to) {
  const Index n = coarse.points[0];
  std::vector<Number> mean(at(n), 0);
  for (std::size_t row = 0; row < rows.count; ++row)
    for (Index i = 0; i < n; ++i) mean[at(i)] += from[rows.first[row] + i];
  const Number whole = Number{1} / static_cast<Number>(rows.count), half = Number{0.5} * whole;
  for (Index i = 0; i < n; ++i) to[2 * i] = whole * mean[at(i)];
  for (Index i = 0; i + 1 < n; ++i) to[2 * i + 1] = half * (mean[at(i)] + mean[at(i + 1)]);
}

/// By point, over the part of its coarse neighbours that are known; 0 where none is.
std::vector<float> interpolation_scale(const CutGrid& fine, const CutGrid& coarse) {
  std::vector<float> known(at(coarse.size())), scale(at(fine.size())), row(at(fine.points[0]));
  for (Index k = 0; k < coarse.size(); ++k) known[at(k)] = coarse.kind[at(k)] != CutPoint::beyond ? 1 : 0;
  for_rows(fine, [&](Index first, Index j, Index k) {
    spread_row(coarse, known.data(), coarse_rows(coarse, j, k), row.data());
    for (Index i = 0; i < fine.points[0]; ++i)
      scale[at(first + i)] = row[at(i)] > 0 && fine.is_unknown(first + i) ? 1 / row[at(i)] : 0;
  });
  return scale;
}

/// The largest link, or pull where there is none.
double largest_coefficient(const CutGrid& grid) {
  double largest = 0;
  for (const std::vector<double>& link : grid.link)
    for (const double one : link) largest = std::max(largest, one);
  if (!(largest > 0))
    for (const double pull : grid.pull) largest = std::max(largest, pull);
  return largest > 0 && std::isfinite(largest) ? largest : 1;
}

}  // namespace

CutRow<float> CutMultigrid::Level::row(Index first) const {
  CutRow<float> made{grid->points[0], grid->dimension, {}, {}, pull.data() + first};
  for (std::size_t axis = 0; axis < grid->dimension; ++axis) {
    made.link[axis] = link[axis].data() + first;
    made.stride[axis] = grid->stride(axis);
  }
  return made;
}

float CutMultigrid::Level::sum_at(Index k) const {
  float sum = pull[at(k)];
  for (std::size_t axis = 0; axis < grid->dimension; ++axis)
    sum += link[axis][at(k)] + link[axis][at(k - grid->stride(axis))];
  return sum;
}

CutMultigrid::Level CutMultigrid::level_of(const CutGrid& grid) const {
  Level made;
  made.grid = &grid;
  const std::size_t size = at(grid.size()), row = at(grid.points[0]);
  const auto as_floats = [&](const std::vector<double>& from, std::vector<float>& to) {
    to.resize(size);
    for (std::size_t k = 0; k < size; ++k) to[k] = static_cast<float>(from[k] / unit_);
  };
  for (std::size_t axis = 0; axis < grid.dimension; ++axis) as_floats(grid.link[axis], made.link[axis]);
  as_floats(grid.pull, made.pull);
  for (std::vector<float>* field : {&made.diagonal, &made.inverse, &made.u, &made.r}) field->assign(size, 0);
  for (Index k = 0; k < grid.size(); ++k)
    if (grid.is_unknown(k)) made.diagonal[at(k)] = made.sum_at(k);
  for (std::vector<float>* colour : {&made.even, &made.odd}) colour->assign(row, 0);
  for (std::size_t i = 0; i < row; ++i) (i % 2 == 0 ? made.even : made.odd)[i] = 1;
  made.rest.assign(at(4 * made.size_of_slab()), 0);
  return made;
}

CutMultigrid::CutMultigrid(const std::vector<const CutGrid*>& grids)
    : unit_(largest_coefficient(*grids.front())) {
  levels_.reserve(grids.size());
  for (const CutGrid* grid : grids) {
    if (!levels_.empty()) {
      Level& finer = levels_.back();
      finer.scale = interpolation_scale(*finer.grid, *grid);
      finer.weight.assign(finer.scale.size(), 0);
    }
    levels_.push_back(level_of(*grid));
  }
  choose(0);
}

void CutMultigrid::choose(std::size_t grid) {
  top_ = grid;
  for (std::vector<float>* field : {&p_, &Ap_, &x_}) field->assign(levels_[grid].u.size(), 0);
}

void CutMultigrid::interpolate(const std::vector<double>& from, std::vector<double>& to) const {
  const Level &level = levels_[top_], &coarse = levels_[top_ + 1];
  to.assign(level.u.size(), 0);
  for_rows(*level.grid, [&](Index first, Index j, Index k) {
    spread_row(*coarse.grid, from.data(), coarse_rows(*coarse.grid, j, k), to.data() + first);
    for (Index i = first; i < first + level.grid->points[0]; ++i)
      to[at(i)] *= static_cast<double>(level.scale[at(i)]);
  });
}

/// One colour of a slab relaxed: points of a colour are not neighbours.
void CutMultigrid::sweep(Level& level, Index slab, bool red) {
  for_slab(*level.grid, slab, [&](Index first, Index j, Index k) {
    cut_kernels::relax(level.row(first), level.inverse.data() + first, level.colour(j, k, red),
                       level.r.data() + first, level.u.data() + first);
  });
}

/// The red sweep over a slab from u = 0.
void CutMultigrid::first_sweep(Level& level, Index slab) {
  for_slab(*level.grid, slab, [&](Index first, Index j, Index k) {
    cut_kernels::relax_zero(level.grid->points[0], level.inverse.data() + first, level.colour(j, k, true),
                            level.r.data() + first, level.u.data() + first);
  });
}

/// What is left of the equations on a slab, weighted for the interpolation's transpose; 0 beside the grid.
void CutMultigrid::find_rest(Level& level, Index slab) {
  float* to = level.rest.data() + (slab & 3) * level.size_of_slab();
  if (slab < 0 || slab >= slabs(*level.grid)) {
    std::fill_n(to, level.size_of_slab(), 0.0F);
    return;
  }
  const Index begin = slab * level.size_of_slab() + (level.grid->dimension > 1 ? level.size_of_slab() : 0);
  for_slab(*level.grid, slab, [&](Index first, Index, Index) {
    cut_kernels::rest(level.row(first), level.weight.data() + first, level.r.data() + first,
                      level.u.data() + first, to + (first - begin));
  });
}

/// The coarse residual on a slab: the transpose of the interpolation.
void CutMultigrid::restrict_rest(const Level& fine, Level& coarse, Index slab) {
  const CutGrid &from = *fine.grid, &to = *coarse.grid;
  const Index n = to.points[0], width = from.points[0] + 2, stride = from.stride(1);
  for (std::vector<float>& sum : sum_) sum.resize(at(width));
  const auto rest = [&](Index s) { return fine.rest.data() + (s & 3) * fine.size_of_slab(); };
  for_slab(to, slab, [&](Index first, Index j, Index) {
    const auto rows_of = [&](Index s, std::vector<float>& sum) {
      const float* row = rest(s) + (2 * j + 1) * stride;
      cut_kernels::tent(width, row - stride, row, row + stride, sum.data());
    };
    if (from.dimension == 3) {
      for (const Index by : {-1, 0, 1}) rows_of(2 * slab + by, sum_[at(by + 1)]);
      cut_kernels::tent(width, sum_[0].data(), sum_[1].data(), sum_[2].data(), sum_[3].data());
    } else {
      cut_kernels::tent(width, rest(2 * slab - 1), rest(2 * slab), rest(2 * slab + 1), sum_[3].data());
    }
    cut_kernels::gather(n, sum_[3].data() + 1, coarse.inverse.data() + first, coarse.r.data() + first);
  });
}

/// u += the interpolated correction, on a slab.
void CutMultigrid::add_coarse(Level& level, const Level& from, Index slab) {
  const Index n = from.grid->points[0];
  mean_.resize(at(n));
  for_slab(*level.grid, slab, [&](Index first, Index j, Index k) {
    const RowsAround rows = coarse_rows(*from.grid, j, k);
    const auto row = [&](std::size_t one) { return from.u.data() + rows.first[one]; };
    const float* mean = row(0);
    if (rows.count > 1) {
      cut_kernels::mean(n, row(0), row(1), row(rows.count - 2), row(rows.count - 1), mean_.data());
      mean = mean_.data();
    }
    cut_kernels::spread(level.grid->points[0], mean, level.weight.data() + first, level.u.data() + first);
  });
}

void CutMultigrid::relax_coarsest(Level& level) {
  std::fill(level.u.begin(), level.u.end(), 0.0F);
  const auto& points = level.grid->points;
  const Index sweeps = 4 * std::max({points[0], points[1], points[2]});
  for (Index k = 0; k < 2 * sweeps; ++k)
    for (const bool red : {k < sweeps, k >= sweeps})
      for (Index s = 0; s < slabs(*level.grid); ++s) sweep(level, s, red);
}

// A sweep over a grid that does not fit into the caches costs what it moves. So the passes of a cycle run
// together, each a slab (a row of a plane grid, a plane of one in space) behind the one that it needs: the
// memory is gone through once on the way down and once on the way up.
template <class SlabDone>
void CutMultigrid::cycle(std::size_t l, SlabDone slab_done) {
  Level& level = levels_[l];
  const Index n = slabs(*level.grid);
  if (l + 1 == levels_.size()) {
    relax_coarsest(level);
    for (Index s = 0; s < n; ++s) slab_done(s);
    return;
  }
  Level& coarse = levels_[l + 1];
  for (Index s = 0; s < n + 4; ++s) {
    first_sweep(level, s);
    sweep(level, s - 1, false);
    find_rest(level, s - 2);
    if (s % 2 == 1) restrict_rest(level, coarse, s / 2 - 1);
  }
  cycle(l + 1, Unheard{});
  for (Index s = 0; s < n + 2; ++s) {
    add_coarse(level, coarse, s);
    sweep(level, s - 1, false);
    sweep(level, s - 2, true);
    if (s >= 2) slab_done(s - 2);
  }
}

/// One step of the conjugate gradients in Polak and Ribière's direction, from the curvature of the last one.
CutMultigrid::Direction CutMultigrid::step(Index count, double last_curvature) {
  Level& level = levels_[top_];
  const CutGrid& grid = *level.grid;
  const Index n = slabs(grid), width = grid.points[0];
  const auto rows_of = [&](Index slab, auto work) {
    for_slab(grid, slab, [&](Index first, Index, Index) { work(first); });
  };
  cut_kernels::Products with;
  cycle(top_, [&](Index slab) {
    rows_of(slab, [&](Index k) {
      cut_kernels::add_products(width, level.r.data() + k, Ap_.data() + k, level.u.data() + k, with);
    });
  });
  if (!(with.of_r > 0)) return {};
  const auto turn = static_cast<float>(count == 0 ? 0 : -with.of_Ap / last_curvature);
  double curvature = 0;
  for (Index s = 0; s < n + 1; ++s) {
    rows_of(s, [&](Index k) {
      if (count == 0)
        std::copy_n(level.u.data() + k, width, p_.data() + k);
      else
        row_kernels::turn(width, turn, level.u.data() + k, p_.data() + k);
    });
    rows_of(s - 1, [&](Index k) {
      curvature += cut_kernels::apply(level.row(k), level.inverse.data() + k, p_.data() + k, Ap_.data() + k);
    });
  }
  if (!(curvature > 0)) return {};
  const auto length =
      static_cast<float>(with.of_r / curvature);  // r·p = r·z, r being at right angles to the last p
  for_rows(grid, [&](Index k, Index, Index) {
    row_kernels::advance(width, length, p_.data() + k, Ap_.data() + k, x_.data() + k, level.r.data() + k);
  });
  return {with.of_r, curvature};
}

Index CutMultigrid::correct(const CutEquations& equations, std::vector<double>& q, double part,
                            double least) {
  Level& level = levels_[top_];
  const CutGrid& grid = *level.grid;
  const double load = equations.largest_load(), unit = load > 0 && std::isfinite(load) ? load : 1;
  const double energy_unit = unit / std::sqrt(unit_), asked = least / energy_unit * (least / energy_unit);
  Index steps = 0;
  double first = 0, round_before = 0;
  for (bool is_done = false; !is_done;) {
    for_rows(grid, [&](Index k, Index, Index) {
      cut_kernels::residual(equations.row(k), equations.load(k), level.inverse.data() + k, 1 / unit,
                            q.data() + k, level.r.data() + k);
    });
    std::fill(x_.begin(), x_.end(), 0.0F);
    double round = 0, before = 0, curvature = 0;
    for (Index count = 0; count < most_steps_of_round; ++count) {
      const Direction here = step(count, curvature);
      is_done = !(here.energy > 0);
      if (is_done) break;
      if (steps++ == 0) first = here.energy;
      if (count == 0) round = here.energy;
      // What the step leaves, if it does as well as the one before, as far as floats can tell.
      const double left =
          here.energy * (count == 0 ? 1 : std::clamp(here.energy / before, float_part * float_part, 1.0));
      is_done = left <= std::max(part * part * first, asked) || steps >= most_steps;
      if (is_done || left <= float_part * float_part * round) break;
      before = here.energy;
      curvature = here.curvature;
    }
    for_rows(grid, [&](Index k, Index, Index) {
      cut_kernels::add(grid.points[0], unit / unit_, x_.data() + k, q.data() + k);
    });
    is_done = is_done || (round_before > 0 && !(round < stuck_part * stuck_part * round_before));
    round_before = round;
  }
  return steps;
}

}  // namespace convex::inline obstacle_problem
