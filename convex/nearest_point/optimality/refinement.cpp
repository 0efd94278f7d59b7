#include "convex/nearest_point/optimality/refinement.hpp"

#include <limits>
#include <utility>

#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline optimality {
namespace {

/// When the first correction is this small a part of what it corrects, the second would be below `enough` by
/// far: the first is then the last.
constexpr double certain_contraction = 0x1p-44;

/// An entry no larger than what may be missing in it is rounding noise about zero.
template <class Noise, class Weight>
double drop_noise(DoubleDoubleVector& x, Noise noise, Weight weight) {
  double dropped = 0;
  for (Index i = 0; i < x.size(); ++i) {
    if (!(std::abs(x.hi[i]) <= noise(i))) continue;
    dropped += weight(i) * x.hi[i] * x.hi[i];
    x.hi[i] = x.lo[i] = 0;
  }
  return dropped;
}

}  // namespace

RefinedPoint refine(const WorkingSet& set) {
  const NearestPointProblem& problem = set.problem();
  RefinedPoint point{DoubleDoubleVector(set.point()),
                     DoubleDoubleVector(Vector(set.lambda().head(set.size())))};
  const double scale = set.scale();
  const double of_A = problem.A.factor_condition(), of_rows = set.factor().inverse_norm();
  // A residual is rounded once, its terms in twice the precision.
  const double of_residuals = 4 * unit_roundoff * unit_roundoff * of_A * (1 + of_rows) * scale;
  const double of_pull = pull_rounding(of_A, 1);
  const double expected = expected_contraction(of_A, of_rows * of_rows, false);
  const double usual = std::min(trusted_contraction / 2, usual_contraction(of_A, of_rows * of_rows));
  double previous = scale;  // the first solve is the correction of nothing
  double pull = std::numeric_limits<double>::infinity();
  Vector dw, dlambda, r2(set.size());
  Vector dq, step;
  const auto drop_noise_of_q = [&](auto noise) {
    const double dropped = drop_noise(point.q, noise, [&](Index i) { return problem.A.diagonal()[i]; });
    point.dropped = std::sqrt(static_cast<double>(problem.dimension()) * dropped);
  };
  const auto drop_noise_of_lambda = [&](auto noise) {
    drop_noise(point.lambda, noise, [](Index) { return 0; });
  };
  for (int k = 0; k < most_refinements; ++k) {
    const Vector r1 = stationarity_residual(problem, point.q, set.rows(), point.lambda);
    for (Index j = 0; j < set.size(); ++j) r2[j] = -slack(problem, set.rows()[at(j)], point.q).value();
    set.correct(problem.A.whiten(r1), r2, dw, dlambda);
    point.last = dw.norm();
    const double previous_pull = std::exchange(pull, 0);
    for (Index j = 0; j < set.size(); ++j) pull += std::abs(dlambda[j]) * set.factor().length(j);
    point.floor = of_residuals + of_pull * pull;
    if (k == 0) point.first = point.last;
    // Once at the rounding of the residuals themselves, corrections no longer shrink: that is the end, not a
    // failure.
    const double floor = at_rounding * scale;
    const double seen = (k == 0 ? point.last > 0 : point.last > floor) ? point.last / previous : 0;
    if (k == 0)
      point.contraction = std::max(seen, std::min(trusted_contraction / 2, expected));
    else  // the second correction shows what the first could only be expected to leave
      point.contraction = std::max({seen, k == 1 ? 0 : point.contraction, usual});
    dq = problem.A.unwhiten(dw);
    step = dlambda;
    if (!(point.contraction < trusted_contraction)) break;
    point.q.add(dq);
    point.lambda.add(step);
    const bool is_held = of_pull * pull <= enough * scale;
    if (k == 0 && point.contraction <= certain_contraction && point.last > 0 && is_held) {
      const double missing = 4 * point.remaining() * problem.A.factor_condition();
      drop_noise_of_q([&](Index i) {
        return std::max(missing / std::sqrt(problem.A.diagonal()[i]), cancelled * std::abs(dq[i]));
      });
      drop_noise_of_lambda([&](Index k_th) {
        return std::max(missing * of_rows / set.factor().length(k_th), cancelled * std::abs(step[k_th]));
      });
      return point;
    }
    const bool at_the_end = point.last <= floor && (is_held || pull > previous_pull / 2);
    // Rows that nearly depend on each other share a pull that says little of q: what one of them has too much
    // is corrected as long as that shrinks.
    const bool is_told = pull <= unit_roundoff * scale || pull > previous_pull / 2;
    if (k > 0 && is_told && (at_the_end || point.remaining() <= enough * scale)) break;
    previous = point.last;
  }
  if (point.contraction < trusted_contraction) {
    // The last correction of an entry is more than what is missing in it.
    drop_noise_of_q([&](Index i) { return 2 * std::abs(dq[i]); });
    drop_noise_of_lambda([&](Index k) { return 2 * std::abs(step[k]); });
  }
  return point;
}

Index most_negative(const WorkingSet& set, const Vector& lambda, double noise) {
  Index worst = -1;
  double lowest = std::min(0.0, -noise);
  for (Index k = 0; k < set.size(); ++k) {
    const double push = lambda[k] * set.factor().length(k);
    if (!set.one_sided(k) || !(push < lowest)) continue;
    lowest = push;
    worst = k;
  }
  return worst;
}

Index most_negative(const WorkingSet& set, const RefinedPoint& refined) {
  return most_negative(set, refined.lambda.hi, 4 * refined.remaining() * set.factor().inverse_norm());
}

namespace {

/// How far the violation of a row that is taken for 0 may leave the point from the edge of that row and S.
double moved_edge(WorkingSet& set, Index a, double violation, WorkingSet::Split& split) {
  set.split(a, split);
  return split.rest > exact_dependence * split.magnitude ? violation / split.rest : 0;
}

}  // namespace

Vector refined_slacks(WorkingSet& set, RefinedPoint& point, const Vector& row_scale) {
  const NearestPointProblem& problem = set.problem();
  const Vector q_size = point.q.hi.cwiseAbs();
  const double plain_rounding = 2 * static_cast<double>(problem.dimension()) * unit_roundoff;
  const double left = point.remaining() + point.dropped;
  Vector rest = problem.U.times(point.q.hi) - problem.s;
  WorkingSet::Split split;
  for (Index a = 0; a < problem.rows(); ++a) {
    const double s = std::abs(problem.s[a]), length = row_scale[a];
    if (set.holds(a)) {
      rest[a] = 0;
    } else if (std::abs(rest[a]) <=
               plain_rounding * (s + problem.U.absolute_dot(a, q_size)) + 2 * length * left) {
      rest[a] = slack(problem, a, point.q).value();
      if (std::abs(rest[a]) > zero_of_pairs * (s + length * set.scale()) + 2 * length * left) continue;
      if (rest[a] < 0 && problem.radii) point.dropped += 2 * moved_edge(set, a, -rest[a], split);
      rest[a] = 0;
    }
  }
  return rest;
}

}  // namespace convex::inline optimality
