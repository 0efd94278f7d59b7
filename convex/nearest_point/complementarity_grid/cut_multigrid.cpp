#include "convex/nearest_point/complementarity_grid/cut_multigrid.hpp"

#include <algorithm>
#include <cmath>

namespace convex {
namespace {

constexpr Index most_steps = 200;

std::size_t at(Index k) { return static_cast<std::size_t>(k); }

/// Calls row(first, j, k) for every row along the first axis, `first` its point 0.
template <class Row>
void for_rows(const CutGrid& grid, Row row) {
  for (Index k = 0; k < grid.points[2]; ++k)
    for (Index j = 0; j < grid.points[1]; ++j) row(grid.at(0, j, k), j, k);
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
    for (std::vector<double>* field : {&level.diagonal, &level.inverse, &level.u, &level.r})
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

void CutMultigrid::set_free(const std::vector<std::uint8_t>& held, const std::vector<std::uint8_t>& taut) {
  std::vector<std::uint8_t> taut_here = taut;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const CutGrid& grid = *level.grid;
    for (Index k = 0; k < grid.size(); ++k) {
      double sum = grid.pull[at(k)];
      if (grid.is_unknown(k))
        for (std::size_t axis = 0; axis < grid.dimension; ++axis)
          sum += grid.link[axis][at(k)] + grid.link[axis][at(k - grid.stride(axis))];
      level.diagonal[at(k)] = sum;
    }
    if (l > 0) {  // neighbours of the fine pendants that are taut
      const CutGrid& fine = *levels_[l - 1].grid;
      std::vector<std::uint8_t> near(at(fine.size()), 0);
      for (std::size_t a = 0; a < fine.pendants.size(); ++a) {
        if (!taut_here[a]) continue;
        for (Index code = 0; code < 27; ++code) {
          Index k = fine.pendants[a].point, rest = code;
          for (std::size_t axis = 0; axis < fine.dimension; ++axis, rest /= 3)
            k += (rest % 3 - 1) * fine.stride(axis);
          near[at(k)] = 1;
        }
      }
      std::vector<std::uint8_t> taut_coarse(grid.pendants.size(), 0);
      const auto place = [&](Index coarse_point) {
        Index k = coarse_point, fine_point = 0;
        for (std::size_t axis = grid.dimension; axis-- > 0;) {
          const Index i = k / grid.stride(axis) - grid.frame(axis);
          k %= grid.stride(axis);
          fine_point += (2 * i + fine.frame(axis)) * fine.stride(axis);
        }
        return fine_point;
      };
      for (std::size_t a = 0; a < grid.pendants.size(); ++a)
        taut_coarse[a] = near[at(place(grid.pendants[a].point))];
      taut_here.swap(taut_coarse);
      const std::vector<std::uint8_t>& fine_free = levels_[l - 1].free;
      for_rows(grid, [&](Index first, Index j, Index k) {
        for (Index i = 0; i < grid.points[0]; ++i) {
          const Index there = fine.at(2 * i, 2 * j, 2 * k);
          level.free[at(first + i)] =
              grid.is_unknown(first + i) && (fine_free[at(there)] != 0 || !fine.is_unknown(there));
        }
      });
    } else {
      for (Index k = 0; k < grid.size(); ++k) level.free[at(k)] = grid.is_unknown(k) && held[at(k)] == 0;
      load_ = grid.load;
      pull_ = grid.pull;
    }
    for (std::size_t a = 0; a < grid.pendants.size(); ++a) {
      if (!taut_here[a]) continue;
      const Pendant& pendant = grid.pendants[a];
      level.diagonal[at(pendant.point)] += pendant.conductance;
      if (l > 0) continue;
      pull_[at(pendant.point)] += pendant.conductance;
      load_[at(pendant.point)] -= pendant.conductance * pendant.shift;
    }
    for (Index k = 0; k < grid.size(); ++k)
      level.inverse[at(k)] =
          level.free[at(k)] != 0 && level.diagonal[at(k)] > 0 ? 1 / level.diagonal[at(k)] : 0;
  }
}

/// out = A u on the free points, 0 elsewhere.
void CutMultigrid::apply(const Level& level, const std::vector<double>& u, std::vector<double>& out) {
  const CutGrid& grid = *level.grid;
  const Index a = grid.stride(0), b = grid.stride(1), c = grid.stride(2), n = grid.points[0];
  for_rows(grid, [&](Index first, Index, Index) {
    const double *v = u.data() + first, *d = level.diagonal.data() + first, *x = grid.link[0].data() + first;
    const std::uint8_t* free = level.free.data() + first;
    double* to = out.data() + first;
    for (Index i = 0; i < n; ++i) to[i] = d[i] * v[i] - x[i] * v[i + a] - x[i - a] * v[i - a];
    if (grid.dimension > 1) {
      const double* y = grid.link[1].data() + first;
      for (Index i = 0; i < n; ++i) to[i] -= y[i] * v[i + b] + y[i - b] * v[i - b];
    }
    if (grid.dimension > 2) {
      const double* z = grid.link[2].data() + first;
      for (Index i = 0; i < n; ++i) to[i] -= z[i] * v[i + c] + z[i - c] * v[i - c];
    }
    for (Index i = 0; i < n; ++i) to[i] = free[i] != 0 ? to[i] : 0;
  });
}

/// One colour relaxed: points of a colour are not neighbours.
void CutMultigrid::sweep(Level& level, bool red) {
  const CutGrid& grid = *level.grid;
  const Index a = grid.stride(0), b = grid.stride(1), c = grid.stride(2), n = grid.points[0];
  for_rows(grid, [&](Index first, Index j, Index k) {
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

/// The coarse residual: the transpose of the interpolation.
void CutMultigrid::restrict_residual(Level& fine, Level& coarse) {
  const CutGrid &from = *fine.grid, &to = *coarse.grid;
  apply(fine, fine.u, z_);
  std::vector<double>& rest = z_;
  for (std::size_t k = 0; k < fine.r.size(); ++k)
    rest[k] = fine.free[k] != 0 ? fine.scale[k] * (fine.r[k] - rest[k]) : 0;
  const Index n = to.points[0];
  std::vector<double> sum(at(from.points[0]) + 2);
  for_rows(to, [&](Index first, Index j, Index k) {
    std::fill(sum.begin(), sum.end(), 0.0);
    for (Index c = -to.frame(2); c <= to.frame(2); ++c)
      for (Index b = -to.frame(1); b <= to.frame(1); ++b) {
        const double weight = (b == 0 ? 1 : 0.5) * (c == 0 ? 1 : 0.5);
        const double* row = rest.data() + from.at(0, 2 * j + b, 2 * k + c);
        for (Index i = 0; i < from.points[0]; ++i) sum[at(i + 1)] += weight * row[i];
      }
    for (Index i = 0; i < n; ++i)
      coarse.r[at(first + i)] = coarse.free[at(first + i)] != 0
                                    ? sum[at(2 * i + 1)] + 0.5 * (sum[at(2 * i)] + sum[at(2 * i + 2)])
                                    : 0;
  });
}

void CutMultigrid::cycle(std::size_t l) {
  Level& level = levels_[l];
  std::fill(level.u.begin(), level.u.end(), 0.0);
  if (l + 1 == levels_.size()) {
    const auto& points = level.grid->points;
    const Index sweeps = 4 * std::max({points[0], points[1], points[2]});
    for (Index k = 0; k < 2 * sweeps; ++k)
      for (const bool red : {k < sweeps, k >= sweeps}) sweep(level, red);
    return;
  }
  sweep(level, true);
  sweep(level, false);
  restrict_residual(level, levels_[l + 1]);
  cycle(l + 1);
  const CutGrid &fine = *level.grid, &coarse = *levels_[l + 1].grid;
  std::vector<double> mean, row(at(fine.points[0]));
  for_rows(fine, [&](Index first, Index j, Index k) {
    spread_row(coarse, levels_[l + 1].u.data(), fine, j, k, mean, row.data());
    for (Index i = 0; i < fine.points[0]; ++i)
      if (level.free[at(first + i)] != 0) level.u[at(first + i)] += level.scale[at(first + i)] * row[at(i)];
  });
  sweep(level, false);
  sweep(level, true);
}

double CutMultigrid::residual(const std::vector<double>& q, std::vector<double>& r) const {
  const Level& level = levels_.front();
  r.assign(q.size(), 0);
  apply(level, q, r);
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

Index CutMultigrid::correct(std::vector<double>& q, std::vector<double>& r, double part) {
  Level& level = levels_.front();
  p_.assign(q.size(), 0);
  Ap_.assign(q.size(), 0);
  z_.assign(q.size(), 0);
  double first = 0, before = 0;
  for (Index step = 0; step < most_steps; ++step) {
    level.r = r;
    cycle(0);
    double of_r = 0, of_Ap = 0;
    for (std::size_t k = 0; k < q.size(); ++k) {
      of_r += r[k] * level.u[k];
      of_Ap += Ap_[k] * level.u[k];
    }
    if (!(of_r > 0)) return step;
    if (step == 0) first = of_r;
    if (step > 0 && of_r <= part * part * first) return step;
    // Polak and Ribière's direction; Ap holds the last one times its step.
    const double beta = step == 0 ? 0 : -of_Ap / before;
    for (std::size_t k = 0; k < q.size(); ++k) p_[k] = level.u[k] + beta * p_[k];
    apply(level, p_, Ap_);
    double curvature = 0;
    for (std::size_t k = 0; k < q.size(); ++k) curvature += p_[k] * Ap_[k];
    if (!(curvature > 0)) return step;
    const double length = of_r / curvature;
    for (std::size_t k = 0; k < q.size(); ++k) {
      q[k] += length * p_[k];
      Ap_[k] *= length;
      r[k] -= Ap_[k];
    }
    before = of_r;
  }
  return most_steps;
}

}  // namespace convex
