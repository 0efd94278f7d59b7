#include "convex/nearest_point/complementarity_grid/cut_multigrid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "convex/nearest_point/complementarity_grid/cut_rows.hpp"

namespace convex::inline complementarity_grid {
namespace {

constexpr Index most_steps = 200;

/// Σ a_i b_i in eight sums, which need not wait for each other.
double dot(const double* a, const double* b, Index n) {
  std::array<double, 8> sum{};
  Index i = 0;
  for (; i + 8 <= n; i += 8)
    for (Index j = 0; j < 8; ++j) sum[at(j)] += a[i + j] * b[i + j];
  for (; i < n; ++i) sum[0] += a[i] * b[i];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/// Calls with every coarse row that lies beside or on a fine row.
template <class Row>
void for_coarse_rows(const CutGrid& coarse, Index j, Index k, Row row) {
  for (Index b = k / 2; b <= (k + 1) / 2; ++b)
    for (Index a = j / 2; a <= (j + 1) / 2; ++a) row(coarse.at(0, a, b));
}

/// One row of coarse values, averaged over the coarse rows around a fine row, spread to it.
void spread_row(const CutGrid& coarse, const double* from, const CutGrid& fine, Index j, Index k,
                std::vector<double>& mean, double* to) {
  const Index n = coarse.points[0];
  mean.assign(at(n), 0);
  double rows = 0;
  for_coarse_rows(coarse, j, k, [&](Index first) {
    for (Index i = 0; i < n; ++i) mean[at(i)] += from[first + i];
    rows += 1;
  });
  const double whole = 1 / rows, half = 0.5 / rows;
  for (Index i = 0; i < n; ++i) to[2 * i] = whole * mean[at(i)];
  for (Index i = 0; i + 1 < n; ++i) to[2 * i + 1] = half * (mean[at(i)] + mean[at(i + 1)]);
  (void)fine;
}

}  // namespace

std::vector<double> CutMultigrid::interpolation_scale(const CutGrid& fine, const CutGrid& coarse) {
  std::vector<double> known(at(coarse.size())), scale(at(fine.size())), mean, row(at(fine.points[0]));
  for (Index k = 0; k < coarse.size(); ++k) known[at(k)] = coarse.kind[at(k)] != CutPoint::beyond ? 1 : 0;
  for_rows(fine, [&](Index first, Index j, Index k) {
    spread_row(coarse, known.data(), fine, j, k, mean, row.data());
    for (Index i = 0; i < fine.points[0]; ++i)
      scale[at(first + i)] = row[at(i)] > 0 && fine.is_unknown(first + i) ? 1 / row[at(i)] : 0;
  });
  return scale;
}

CutMultigrid::CutMultigrid(std::vector<const CutGrid*> grids) {
  for (const CutGrid* grid : grids) {
    Level level;
    level.grid = grid;
    for (std::vector<double>* field : {&level.diagonal, &level.inverse, &level.u, &level.r, &level.rest})
      field->assign(at(grid->size()), 0);
    level.free.assign(at(grid->size()), 0);
    if (!levels_.empty()) levels_.back().scale = interpolation_scale(*levels_.back().grid, *grid);
    levels_.push_back(std::move(level));
  }
}

void CutMultigrid::interpolate(const CutGrid& coarse, const std::vector<double>& from, const CutGrid& fine,
                               std::vector<double>& to) {
  const std::vector<double> scale = interpolation_scale(fine, coarse);
  std::vector<double> mean;
  to.assign(at(fine.size()), 0);
  for_rows(fine, [&](Index first, Index j, Index k) {
    spread_row(coarse, from.data(), fine, j, k, mean, to.data() + first);
    for (Index i = first; i < first + fine.points[0]; ++i) to[at(i)] *= scale[at(i)];
  });
}

/// out = A u on the free points of a row, 0 elsewhere.
void CutMultigrid::apply_row(const Level& level, const double* u, Index first, double* out) {
  const CutGrid& grid = *level.grid;
  const Index a = grid.stride(0), b = grid.stride(1), c = grid.stride(2), n = grid.points[0];
  const double *v = u + first, *d = level.diagonal.data() + first, *x = grid.link[0].data() + first;
  const std::uint8_t* free = level.free.data() + first;
  for (Index i = 0; i < n; ++i) out[i] = d[i] * v[i] - x[i] * v[i + a] - x[i - a] * v[i - a];
  if (grid.dimension > 1) {
    const double* y = grid.link[1].data() + first;
    for (Index i = 0; i < n; ++i) out[i] -= y[i] * v[i + b] + y[i - b] * v[i - b];
  }
  if (grid.dimension > 2) {
    const double* z = grid.link[2].data() + first;
    for (Index i = 0; i < n; ++i) out[i] -= z[i] * v[i + c] + z[i - c] * v[i - c];
  }
  for (Index i = 0; i < n; ++i) out[i] = free[i] != 0 ? out[i] : 0;
}

/// One colour of a slab relaxed: points of a colour are not neighbours.
void CutMultigrid::sweep(Level& level, Index slab, bool red) {
  const CutGrid& grid = *level.grid;
  const Index a = grid.stride(0), b = grid.stride(1), c = grid.stride(2), n = grid.points[0];
  for_slab(grid, slab, [&](Index first, Index j, Index k) {
    double* v = level.u.data() + first;
    const double *r = level.r.data() + first, *inverse = level.inverse.data() + first;
    const double *x = grid.link[0].data() + first,
                 *y = grid.dimension > 1 ? grid.link[1].data() + first : nullptr,
                 *z = grid.dimension > 2 ? grid.link[2].data() + first : nullptr;
    const Index start = (j + k + (red ? 0 : 1)) % 2;
    if (grid.dimension == 3) {
      for (Index i = start; i < n; i += 2)
        v[i] = inverse[i] * (r[i] + x[i] * v[i + a] + x[i - a] * v[i - a] + y[i] * v[i + b] +
                             y[i - b] * v[i - b] + z[i] * v[i + c] + z[i - c] * v[i - c]);
    } else if (grid.dimension == 2) {
      for (Index i = start; i < n; i += 2)
        v[i] = inverse[i] *
               (r[i] + x[i] * v[i + a] + x[i - a] * v[i - a] + y[i] * v[i + b] + y[i - b] * v[i - b]);
    } else {
      for (Index i = start; i < n; i += 2) v[i] = inverse[i] * (r[i] + x[i] * v[i + a] + x[i - a] * v[i - a]);
    }
  });
}

/// The red sweep over a slab from u = 0.
void CutMultigrid::first_sweep(Level& level, Index slab) {
  for_slab(*level.grid, slab, [&](Index first, Index j, Index k) {
    double* v = level.u.data() + first;
    const double *r = level.r.data() + first, *inverse = level.inverse.data() + first;
    const Index n = level.grid->points[0], red = (j + k) % 2;
    for (Index i = 0; i < n; ++i) v[i] = inverse[i] * r[i];
    for (Index i = 1 - red; i < n; i += 2) v[i] = 0;
  });
}

/// What is left of the equations on a slab, weighted for the interpolation's transpose.
void CutMultigrid::rest(Level& level, Index slab) {
  for_slab(*level.grid, slab, [&](Index first, Index, Index) {
    double* to = level.rest.data() + first;
    const double *r = level.r.data() + first, *scale = level.scale.data() + first;
    const std::uint8_t* free = level.free.data() + first;
    apply_row(level, level.u.data(), first, to);
    for (Index i = 0; i < level.grid->points[0]; ++i) to[i] = free[i] != 0 ? scale[i] * (r[i] - to[i]) : 0;
  });
}

/// The coarse residual on a slab: the transpose of the interpolation.
void CutMultigrid::restrict_rest(const Level& fine, Level& coarse, Index slab) {
  const CutGrid &from = *fine.grid, &to = *coarse.grid;
  const Index n = to.points[0];
  sum_.resize(at(from.points[0]) + 2);
  for_slab(to, slab, [&](Index first, Index j, Index k) {
    std::fill(sum_.begin(), sum_.end(), 0.0);
    for (Index c = -to.frame(2); c <= to.frame(2); ++c)
      for (Index b = -to.frame(1); b <= to.frame(1); ++b) {
        const double weight = (b == 0 ? 1 : 0.5) * (c == 0 ? 1 : 0.5);
        const double* row = fine.rest.data() + from.at(0, 2 * j + b, 2 * k + c);
        for (Index i = 0; i < from.points[0]; ++i) sum_[at(i + 1)] += weight * row[i];
      }
    for (Index i = 0; i < n; ++i)
      coarse.r[at(first + i)] = coarse.free[at(first + i)] != 0
                                    ? sum_[at(2 * i + 1)] + 0.5 * (sum_[at(2 * i)] + sum_[at(2 * i + 2)])
                                    : 0;
  });
}

/// u += the interpolated correction, on a slab.
void CutMultigrid::add_coarse(Level& level, const Level& from, Index slab) {
  const CutGrid& fine = *level.grid;
  row_.resize(at(fine.points[0]));
  for_slab(fine, slab, [&](Index first, Index j, Index k) {
    spread_row(*from.grid, from.u.data(), fine, j, k, sum_, row_.data());
    double* u = level.u.data() + first;
    const double* scale = level.scale.data() + first;
    const std::uint8_t* free = level.free.data() + first;
    for (Index i = 0; i < fine.points[0]; ++i) u[i] = free[i] != 0 ? u[i] + scale[i] * row_[at(i)] : u[i];
  });
}

// A sweep over a grid that does not fit into the caches costs what it moves. So the passes of a cycle run
// together, each a slab (a row of a plane grid, a plane of one in space) behind the one that it needs: the
// memory is gone through once on the way down and once on the way up.
void CutMultigrid::cycle(std::size_t l) {
  Level& level = levels_[l];
  const Index n = slabs(*level.grid);
  if (l + 1 == levels_.size()) {
    std::fill(level.u.begin(), level.u.end(), 0.0);
    const auto& points = level.grid->points;
    const Index sweeps = 4 * std::max({points[0], points[1], points[2]});
    for (Index k = 0; k < 2 * sweeps; ++k)
      for (const bool red : {k < sweeps, k >= sweeps})
        for (Index s = 0; s < n; ++s) sweep(level, s, red);
    return;
  }
  Level& coarse = levels_[l + 1];
  for (Index s = 0; s < n + 4; ++s) {
    first_sweep(level, s);
    sweep(level, s - 1, false);
    rest(level, s - 2);
    if (s % 2 == 1) restrict_rest(level, coarse, s / 2 - 1);
  }
  cycle(l + 1);
  for (Index s = 0; s < n + 2; ++s) {
    add_coarse(level, coarse, s);
    sweep(level, s - 1, false);
    sweep(level, s - 2, true);
  }
}

double CutMultigrid::residual(const std::vector<double>& q, std::vector<double>& r) const {
  const Level& level = levels_.front();
  r.assign(q.size(), 0);
  for_rows(*level.grid,
           [&](Index first, Index, Index) { apply_row(level, q.data(), first, r.data() + first); });
  double largest = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    r[k] = level.free[k] != 0 ? load_[k] - r[k] : 0;
    largest = std::max(largest, std::abs(r[k]) * level.inverse[k]);
  }
  return largest;
}

double CutMultigrid::push(const std::vector<double>& q, Index k) const {
  const CutGrid& grid = *levels_.front().grid;
  double sum = pull_[at(k)] * q[at(k)] - load_[at(k)];
  for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
    const Index s = grid.stride(axis);
    sum += grid.link[axis][at(k)] * (q[at(k)] - q[at(k + s)]) +
           grid.link[axis][at(k - s)] * (q[at(k)] - q[at(k - s)]);
  }
  return sum;
}

void CutMultigrid::relax(std::vector<double>& q, int sweeps) const {
  const Level& level = levels_.front();
  const CutGrid& grid = *level.grid;
  const auto relax_point = [&](Index k) {
    if (!grid.is_unknown(k) || !(level.diagonal[at(k)] > 0)) return;
    double sum = load_[at(k)];
    for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
      const Index s = grid.stride(axis);
      const double* link = grid.link[axis].data() + k;
      sum += link[0] * q[at(k + s)] + link[-s] * q[at(k - s)];
    }
    const double free = sum / level.diagonal[at(k)];
    q[at(k)] = grid.kind[at(k)] == CutPoint::bounded ? std::max(0.0, free) : free;
  };
  for (int colour = 0; colour < 2 * sweeps; ++colour)
    for_rows(grid, [&](Index first, Index j, Index k) {
      for (Index i = (j + k + colour) % 2; i < grid.points[0]; i += 2) relax_point(first + i);
    });
}

double CutMultigrid::energy(const std::vector<double>& q) const {
  double sum = 0;
  for (std::size_t k = 0; k < q.size(); ++k)
    if (levels_.front().free[k] != 0) sum += std::abs(load_[k] * q[k]);
  return std::isfinite(sum) ? std::sqrt(sum) : 0;
}

Index CutMultigrid::correct(std::vector<double>& q, std::vector<double>& r, double part, double least) {
  Level& level = levels_.front();
  const CutGrid& grid = *level.grid;
  const Index n = slabs(grid), row = grid.points[0];
  p_.assign(q.size(), 0);
  Ap_.assign(q.size(), 0);
  level.r.swap(r);  // the residual stays where the cycle reads it
  double first = 0, before = 0;
  Index step = 0;
  for (; step < most_steps; ++step) {
    cycle(0);
    double of_r = 0, of_Ap = 0;
    for_rows(grid, [&](Index k, Index, Index) {
      of_r += dot(level.r.data() + k, level.u.data() + k, row);
      of_Ap += dot(Ap_.data() + k, level.u.data() + k, row);
    });
    if (!(of_r > 0)) break;
    if (step == 0) first = of_r;
    if (step > 0 && of_r <= std::max(part * part * first, least * least)) break;
    // Polak and Ribière's direction; Ap holds the last one times its step.
    const double beta = step == 0 ? 0 : -of_Ap / before;
    double curvature = 0;
    for (Index s = 0; s < n + 1; ++s) {
      for_slab(grid, s, [&](Index k, Index, Index) {
        for (Index i = k; i < k + row; ++i) p_[at(i)] = level.u[at(i)] + beta * p_[at(i)];
      });
      for_slab(grid, s - 1, [&](Index k, Index, Index) {
        apply_row(level, p_.data(), k, Ap_.data() + k);
        curvature += dot(p_.data() + k, Ap_.data() + k, row);
      });
    }
    if (!(curvature > 0)) break;
    const double length = of_r / curvature;
    for_rows(grid, [&](Index k, Index, Index) {
      for (Index i = k; i < k + row; ++i) {
        q[at(i)] += length * p_[at(i)];
        Ap_[at(i)] *= length;
        level.r[at(i)] -= Ap_[at(i)];
      }
    });
    before = of_r;
  }
  level.r.swap(r);
  return step;
}

}  // namespace convex::inline complementarity_grid
