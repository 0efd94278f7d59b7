#include "convex/nearest_point/proof/open_rows.hpp"

#include <cmath>

#include "convex/nearest_point/automatic.hpp"

namespace convex::inline proof {
namespace {

/// A direction d with u_a·d about `length_a` on one-sided rows and 0 on two-sided ones, as short as can be.
std::optional<Vector> opening(const NearestPointProblem& problem, const std::vector<Index>& rows,
                              const std::vector<bool>& two_sided, const Vector& length) {
  NearestPointProblem open{problem.A,
                           Vector::Zero(problem.dimension()),
                           problem.U.select(rows),
                           Vector::Zero(static_cast<Index>(rows.size())),
                           {}};
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (two_sided[at(rows[k])])
      open.two_sided.push_back(static_cast<Index>(k));
    else
      open.s[static_cast<Index>(k)] = length[rows[k]];
  const Solution found = automatic(open, {.limit = 0});  // whatever it is, what it opens is measured
  if (found.q.size() != problem.dimension() || !found.q.allFinite()) return std::nullopt;
  return found.q;
}

/// u·d within bounds, for every row within the radii.
struct Range {
  double low = 0, high = 0;
};

Range along(const Vector& row, const RadiiOf& radii, Index a, const Vector& d, double more) {
  const double product = row.dot(d);
  const double off =
      above(gamma(d.size()) * row.cwiseAbs().dot(d.cwiseAbs()) + radii.row_times(a, d.cwiseAbs()) + more);
  return {product - above(off), product + above(off)};
}

/// ||u_a - U_Sᵀc||_(A⁻¹) at most, for the best c that doubles find: 0 for a row that depends on those held.
double distance_from_held(const Vector& u, Index a, const HeldRows& held) {
  const RadiiOf& radii = held.radii;
  const Index n = held.P.dimension(), k = held.U.rows();
  const Vector c = coefficients_on_held(held, u);
  CompensatedSums rest(n);
  rest.add(u.data(), 1);
  Vector row(n);
  for (Index r = 0; r < k; ++r) {
    if (std::abs(c[r]) < smallest_ordinary) continue;
    row = held.U.row(r);
    rest.add(row.data(), -c[r]);
  }
  Vector value, spread;
  rest.result(value, spread);
  spread += radii.rows_transposed_times(held.rows, c.cwiseAbs(), n);
  spread += radii.rows_transposed_times({a}, Vector::Ones(1), n);
  return dual_length_above(held.P, value, spread);
}

}  // namespace

Vector coefficients_on_held(const HeldRows& held, const Vector& u) {
  return held.T * (held.Z.transpose() * held.P.times_X(u));
}

std::optional<OpenBound> bound_with_open_rows(const HeldRows& held, const std::vector<OpenRow>& open) {
  const NearestPointProblem& problem = held.problem;
  const RadiiOf& radii = held.radii;
  const Preconditioned& P = held.P;
  const HeldPoint& point = held.point;
  const Index n = problem.dimension(), k = held.U.rows();
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const Vector length = problem.U.lengths(problem.A.diagonal().cwiseInverse());
  std::vector<Index> rows = held.rows;
  for (const OpenRow& o : open) rows.push_back(o.row);
  const auto d = opening(problem, rows, two_sided, length);
  if (!d || !is_ordinary(Vector((d->array().abs() >= smallest_ordinary).select(*d, 0.0))))
    return std::nullopt;

  // d + c with U_E c = -U_E d on the two-sided rows and 0 on the others held; ||c||_A is at most `mend`.
  Vector row(n);
  Vector missed = Vector::Zero(k);
  for (Index r = 0; r < k; ++r) {
    if (!two_sided[at(held.rows[at(r)])]) continue;
    row = held.U.row(r);
    const Range range = along(row, radii, held.rows[at(r)], *d, 0);
    missed[r] = std::max(std::abs(range.low), std::abs(range.high));
  }
  const double weak = above(std::sqrt((1 + P.delta) / below(1 - held.delta)));
  const double mend = k > 0 ? above(weak * norm_above(held.T.cwiseAbs().transpose() * missed)) : 0;
  const double stride = above(length_above(P, radii, *d) + mend);

  // How far every row opens, and what that costs: λ_S·U_S d.
  double cost = 0, steepest = 0;
  for (Index r = 0; r < k; ++r) {
    if (two_sided[at(held.rows[at(r)])]) continue;
    row = held.U.row(r);
    const Range range = along(row, radii, held.rows[at(r)], *d, 0);
    const double lambda = point.lambda[r] + point.dlambda[r], radius = point.multiplier_radius[r];
    const double least = held.least_multiplier(r);
    if (!(range.low >= 0) || !(least > 0)) return std::nullopt;
    cost += above(lambda + radius) * range.high;
    steepest = std::max(steepest, above(norm_above(held.T.row(r)) / least));
  }
  double step = 0, off_held = 0;
  for (const OpenRow& o : open) {
    problem.U.copy_row(o.row, row);
    const double imbalance =
        dual_length_above(P, row, radii.rows_transposed_times({o.row}, Vector::Ones(1), n));
    const double opens = along(row, radii, o.row, *d, above(imbalance * mend)).low;
    if (!(opens > 0)) return std::nullopt;
    step = std::max(step, above(o.below_zero / opens));
    off_held = std::max(off_held, above(distance_from_held(row, o.row, held) / opens));
  }
  // P(q*) <= P(q_S + step d): λ_S·U_S(q* - q_S) + ½||q* - q_S||² <= κ.
  const double kappa = above(step * cost + 0.5 * above(step * step) * above(stride * stride));
  const double crude = above(std::sqrt(2 * kappa));
  // Along the working set; and across them, where only the open rows push, Σ λ*_d (u_d·d) <= (A q* - z)·d.
  const double held_part = above(weak * steepest * kappa);
  const double across = above(off_held * above(cost + crude * stride));
  OpenBound found{above(held_part + across), std::max(crude, above(step * stride))};
  if (!std::isfinite(found.shift) || !std::isfinite(found.reach)) return std::nullopt;
  found.shift = std::min(found.shift, crude);
  return found;
}

}  // namespace convex::inline proof
