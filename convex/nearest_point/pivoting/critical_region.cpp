#include "convex/nearest_point/pivoting/critical_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/nearest_point/pivoting/corrections.hpp"
#include "convex/nearest_point/pivoting/gram_solution.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Corrections of a column, before the region is given up.
constexpr int most_corrections = 6;

/// What may be missing, of the scale or of the rounding of the answer, so that the bound is that of the
/// latter.
constexpr double beside_scale = 0x1p-57, beside_rounding = 0x1p-4;

/// No less than the largest ||x||_A over ||x||_D, squared: by the largest sum of a row of D^(-1/2) A
/// D^(-1/2).
double largest_over_diagonal(const CriticalRegion& region) {
  const Index n = region.p.n;
  double most = 0;
  for (Index i = 0; i < n; ++i) {
    double sum = 0;
    for (Index j = 0; j < n; ++j) sum += std::abs(region.p.A[i * n + j]) / region.length[j];
    most = std::max(most, sum / region.length[i]);
  }
  return most;
}

/// Splits the columns, in twice the working precision before. False when an entry is not finite.
bool split(CriticalRegion& region) {
  const double count = static_cast<double>(region.columns);
  double square = 0;
  for (Index i = 0; i < region.stride; ++i) {
    double most = 0, sum = 0;
    for (Index j = 0; j < region.columns; ++j) {
      const double size = std::abs(region.leading(i, j));
      most = std::max(most, size);
      sum += size;
    }
    if (!std::isfinite(sum)) return false;
    const double shift = CriticalRegion::leaves_leading * most;
    for (Index j = 0; j < region.columns; ++j) {
      double &leading = region.leading(i, j), &rest = region.rest(i, j);
      const double whole = leading;
      leading = (whole + shift) - shift;
      rest += whole - leading;
    }
    const double length = i < region.p.n ? region.length[i] * (sum + count * most) : 0;
    square += length * length;
  }
  // Sums of products with a rest are added up in doubles, every other column apart.
  region.error_of_sums = (count / 2 + 4) * unit_roundoff * CriticalRegion::beyond_leading *
                         std::sqrt(largest_over_diagonal(region) * square);
  return std::isfinite(region.error_of_sums);
}

/// The point of an entry of (z, s_S) that is 1, all others 0, corrected: the j-th column. False when it
/// cannot be told.
bool find_column(GramWorkingSet& set, Index j, CriticalRegion& region) {
  const GramPoint& p = set.point();
  if (!set.keep_working_set()) return false;
  Corrections known;
  for (int pass = 0; pass < 2 || p.step > at_rounding * known.scale; ++pass)
    if (pass == most_corrections || !set.correct(pass == 0, 0) || !known.note(p)) return false;
  const double over = 1 / region.unit[j];
  double largest_unit = 0;  // the largest ||·||_D of a coordinate
  const auto take = [&](Index i, double leading, double rest) {
    region.leading(i, j) = over * leading;
    region.rest(i, j) = over * rest;
  };
  for (Index i = 0; i < p.n; ++i) {
    take(i, p.q[i], p.q_low[i]);
    largest_unit = std::max(largest_unit, region.length[i]);
  }
  for (Index k = 0; k < p.size; ++k) take(p.n + k, p.lambda[k], p.lambda_low[k]);
  // And of what underflows.
  region.error[j] = over * known.remaining +
                    std::sqrt(static_cast<double>(p.n)) * largest_unit * std::numeric_limits<double>::min();
  return std::isfinite(region.error[j]) && std::isfinite(region.unit[j]);
}

}  // namespace

/// Cache lines that it takes.
Index CriticalRegion::lines(const GramPoint& held) {
  const Index columns = held.n + held.size, stride = padded(columns), m = padded(held.all),
              side_by_side = held.all <= few_rows ? m * held.n : 0;
  return (10 * stride + 2 * stride * columns + padded(held.size) * held.size + 4 * held.ld +
          6 * padded(held.size) + 5 * m + side_by_side) /
         8;
}

CriticalRegion::CriticalRegion(GramPoint& held) : columns(held.n + held.size), stride(padded(columns)) {
  p.n = held.n, p.all = held.all, p.ld = held.ld, p.size = held.size;
  p.T = held.T, p.inverse = held.inverse, p.A = held.A, p.U = held.U;
  has_all = p.all <= few_rows;
  const Index k = padded(p.size), m = padded(p.all);
  arena.start(lines(held));
  for (double** v : {&unit, &over_unit, &error, &length, &pull, &x, &x_leading, &x_rest, &y, &y_low})
    *v = arena.take_filled(stride, 0.0);
  split = arena.take_filled(2 * stride * columns, 0.0);
  gram = arena.take_filled(k * p.size, 0.0);
  for (double** v : {&p.z, &p.w_free, &p.diagonal, &p.q}) *v = arena.take_filled(p.ld, 0.0);
  for (double** v : {&p.lambda, &p.length, &p.pull, &p.held_slack}) *v = arena.take_filled(k, 0.0);
  p.rows = arena.take<Index>(k);
  for (double** v : {&level, &enter, &p.row_scale, &p.slack}) *v = arena.take_filled(m, 0.0);
  p.close = arena.take<Index>(m);
  copy_packs(p.ld, held.diagonal, p.diagonal);
  std::copy_n(held.rows, p.size, p.rows);
  std::copy_n(held.length, p.size, p.length);
  std::copy_n(held.pull, p.size, p.pull);
  for (Index a = 0; a < p.all; ++a) enter[a] = 1 / (p.row_scale[a] = held.row_scale[a]);
  for (Index j = 0; j < p.size; ++j) enter[p.rows[j]] = 0;
  const auto take_length = [&](Index i, double size, bool either_sign) {
    length[i] = size;
    pull[i] = either_sign ? -size : size;
    unit[i] = std::ldexp(1.0, -std::ilogb(size));
    over_unit[i] = 1 / unit[i];
  };
  for (Index i = 0; i < p.n; ++i) take_length(i, std::sqrt(p.diagonal[i]), true);
  for (Index j = 0; j < p.size; ++j) take_length(p.n + j, p.length[j], !(p.pull[j] > 0));
  Matrix V = Matrix::Zero(p.ld, p.size);
  for (Index j = 0; j < p.size; ++j) {
    std::copy_n(p.U + p.rows[j] * p.n, p.n, V.col(j).data());
    dense_kernels().forward(p.n, p.ld, p.T, p.inverse, V.col(j).data());
    for (Index i = 0; i <= j; ++i) gram[i * k + j] = gram[j * k + i] = V.col(i).dot(V.col(j));
  }
  if (!has_all) return;
  raw = arena.take<double>(m * p.n);
  Index rows[few_rows];
  for (Index a = 0; a < p.all; ++a) rows[a] = a;
  for (Index a = 0; a < p.all; a += 8)
    dense_kernels().side_by_side(p.n, p.all, p.U, rows + a, std::min<Index>(8, p.all - a), raw + a * p.n);
}

std::unique_ptr<CriticalRegion> find_critical_region(GramWorkingSet& set, NearestPointProblem& problem) {
  GramPoint& p = set.point();
  // A row of zeros has no length that its slack could be compared with.
  if (p.n + p.size > CriticalRegion::most_columns ||
      !std::all_of(p.row_scale, p.row_scale + p.all, [](double length) { return length > 0; }))
    return nullptr;
  auto region = std::make_unique<CriticalRegion>(p);
  Vector z = std::exchange(problem.z, Vector::Zero(p.n)), s = std::exchange(problem.s, Vector::Zero(p.all));
  bool is_known = true;
  for (Index j = 0; j < region->columns && is_known; ++j) {
    double& entry = j < p.n ? problem.z[j] : problem.s[region->p.rows[j - p.n]];
    entry = 1;
    is_known = find_column(set, j, *region);
    entry = 0;
  }
  problem.z = std::move(z);
  problem.s = std::move(s);
  if (!is_known || !split(*region)) region.reset();
  return region;
}

bool solve_in_critical_region(CriticalRegion& region, const NearestPointProblem& problem,
                              const Accuracy& accuracy, Solution& solution) {
  GramPoint& p = region.p;
  small_kernels().take_affine_point(region, problem.z.data(), problem.s.data());
  if (!region.has_all) dense_kernels().slacks(p.all, p.n, p.U, p.q, problem.s.data(), p.slack);
  set_held_slacks_apart(p);
  PointError known;
  known.scale = p.norm();
  known.rounding = std::sqrt(static_cast<double>(p.n)) * region.rounded;
  known.bound = 2 * region.remaining + known.rounding;
  const double near = near_zero * std::max(known.scale, p.magnitude);
  if (!(region.least > near &&
        region.remaining <= std::max(beside_scale * known.scale, beside_rounding * known.rounding) &&
        known.bound <= accuracy.tolerance * std::max(1.0, p.acceleration_norm)))
    return false;
  if (!region.has_all && close_rows(p, problem, near_zero, near, 0) > 0) return false;
  write(problem, p, known, accuracy, solution);
  return solution.status == Status::solved;
}

}  // namespace convex::inline pivoting
