#include "convex/nearest_point/proof/enclosure.hpp"

#include <algorithm>
#include <cmath>

#include "convex/linear_algebra/pivoted_qr.hpp"
#include "convex/nearest_point/cone_projection.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/proof/exact_dependence.hpp"
#include "convex/nearest_point/proof/held_point.hpp"
#include "convex/nearest_point/proof/kept_point.hpp"
#include "convex/nearest_point/proof/open_rows.hpp"
#include "convex/nearest_point/proof/sparse_enclosure.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline proof {
namespace {

/// Dense matrices of X and of the active rows are made up to these sizes.
constexpr Index largest_dimension = 1500, most_active_entries = largest_dimension * largest_dimension;

bool multipliers_are_positive(const HeldRows& held) {
  for (std::size_t k = 0; k < held.rows.size(); ++k)
    if (!held.problem.is_two_sided(held.rows[k]) && !(held.least_multiplier(static_cast<Index>(k)) > 0))
      return false;
  return true;
}

constexpr std::size_t most_others = 60;

/// The rows of the working set that make up row a, as doubles see it; `against`: each one-sided one with a
/// negative part.
struct Parts {
  std::vector<Index> others;
  bool against = true;
};

Parts parts_of(const HeldRows& held, Index a) {
  constexpr double noticeable = 1e-9;
  const Vector c = coefficients_on_held(held, held.problem.U.row(a));
  Parts parts;
  for (Index r = 0; r < c.size(); ++r) {
    if (!(std::abs(c[r]) > noticeable * c.cwiseAbs().maxCoeff())) continue;
    parts.others.push_back(held.rows[at(r)]);
    parts.against = parts.against && (c[r] < 0 || held.problem.is_two_sided(parts.others.back()));
  }
  return parts;
}

/// Whether the open rows are exactly implied by rows of the working set at which doubles find them to be
/// combinations.
bool follow(const HeldRows& held, const std::vector<OpenRow>& open) {
  if (held.radii.any()) return open.empty();
  std::vector<Index> together;
  for (const OpenRow& o : open) {
    const Parts parts = parts_of(held, o.row);
    if (parts.others.size() > most_others)
      together.push_back(o.row);
    else if (!follow_exactly(held.problem, {o.row}, parts.others, most_word_operations))
      return false;
  }
  return together.empty() || follow_exactly(held.problem, together, held.rows, most_word_operations);
}

/// At least ||q* - q_S||_A: 0 where every other slack is positive, or exactly implied not to be negative.
std::optional<double> shift_of_open_rows(const HeldRows& held) {
  const HeldSlacks slacks(held);
  std::vector<OpenRow> open = slacks.open(0);
  const auto is_two_sided = [&](const OpenRow& row) { return held.problem.is_two_sided(row.row); };
  if (follow(held, open)) return 0;
  // Rows that the motion may reach are counted as open, until no other is reached.
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    if (std::any_of(open.begin(), open.end(), is_two_sided)) return std::nullopt;
    const auto bound = bound_with_open_rows(held, open);
    if (!bound) return std::nullopt;
    std::vector<OpenRow> reached = slacks.open(bound->reach);
    if (reached.size() == open.size()) return bound->shift;
    open = std::move(reached);
  }
  return std::nullopt;
}

/// Radii as bounds need them: none so small that a product of it might underflow.
EntryRadii ordinary(EntryRadii radii) {
  const auto raise = [](double r) { return r > 0 ? std::max(r, smallest_ordinary) : r; };
  for (double& r : Eigen::Map<Vector>(radii.A.valuePtr(), radii.A.nonZeros())) r = raise(r);
  for (double& r : Eigen::Map<Vector>(radii.U.valuePtr(), radii.U.nonZeros())) r = raise(r);
  radii.z = radii.z.unaryExpr(raise);
  radii.s = radii.s.unaryExpr(raise);
  return radii;
}

/// Rows to hold, with multipliers.
struct Guess {
  std::vector<Index> rows;
  Vector lambda;
};

/// Independent rows, among those without slack, that make R = A q - z (Lawson and Hanson's method ends at
/// such rows), and as many of the two-sided rows as are independent.
std::optional<Guess> independent(const NearestPointProblem& problem, const Solution& solution) {
  std::vector<Index> rows;
  if (!problem.two_sided.empty()) {
    const linear_algebra::PivotedQr factor(whitened_rows(problem, problem.two_sided));
    for (Index r = 0; r < factor.rank; ++r)
      rows.push_back(problem.two_sided[at(factor.order[static_cast<std::size_t>(r)])]);
  }
  const std::size_t two_sided = rows.size();
  constexpr double tight = 1e-9;
  const Vector slack = problem.U.times(solution.q) - problem.s;
  for (Index a = 0; a < problem.rows(); ++a)
    if (std::abs(slack[a]) <=
            tight * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, solution.q.cwiseAbs())) &&
        !problem.is_two_sided(a))
      rows.push_back(a);
  const Vector residual = problem.A.multiply(solution.q) - problem.z;
  const ConeProjection push = cone_projection(whitened_rows(problem, rows), problem.A.whiten(residual),
                                              indices_below(static_cast<Index>(two_sided)));
  if (!push.finished) return std::nullopt;
  Guess found{{}, Vector::Zero(problem.rows())};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double lambda = push.lambda[static_cast<Index>(r)];
    if (lambda == 0 && r >= two_sided) continue;
    found.rows.push_back(rows[r]);
    found.lambda[rows[r]] = lambda;
  }
  return found;
}

/// The rows but for one-sided ones whose multiplier at the refined point is 0 but for its radius.
std::vector<Index> without_idle_rows(const HeldRows& held) {
  std::vector<Index> kept;
  for (std::size_t r = 0; r < held.rows.size(); ++r) {
    const auto k = static_cast<Index>(r);
    const double multiplier = std::abs(held.point.lambda[k] + held.point.dlambda[k]);
    if (held.problem.is_two_sided(held.rows[r]) || !(multiplier <= above(held.point.multiplier_radius[k])))
      kept.push_back(held.rows[r]);
  }
  return kept;
}

/// Whether dense matrices of X and of so many rows may be made.
bool is_dense_size(const NearestPointProblem& problem, std::size_t rows) {
  return (problem.dimension() <= largest_dimension || is_diagonal(problem.A)) &&
         static_cast<Index>(rows) * problem.dimension() <= most_active_entries;
}

bool is_ordinary_problem(const NearestPointProblem& problem, const Solution& solution) {
  if (solution.q.size() != problem.dimension() || !is_ordinary(problem.z) || !is_ordinary(problem.s) ||
      !is_ordinary(solution.q) || !is_ordinary(solution.lambda))
    return false;
  return problem.U.is_sparse() ? is_ordinary(problem.U.sparse().coeffs()) : is_ordinary(problem.U.dense());
}

/// Open rows that add up to 0 with rows of the working set, and their bounds: equalities in disguise.
std::vector<Index> disguised(const HeldRows& held) {
  std::vector<Index> found;
  for (const OpenRow& o : HeldSlacks(held).open(0)) {
    const Parts parts = parts_of(held, o.row);
    if (!parts.against || parts.others.size() > most_others ||
        !are_equalities(held.problem, o.row, parts.others))
      continue;
    found.push_back(o.row);
    found.insert(found.end(), parts.others.begin(), parts.others.end());
  }
  return found;
}

/// The same set of points, with those rows two-sided.
NearestPointProblem with_equalities(NearestPointProblem problem, const std::vector<Index>& rows) {
  std::vector<Index>& all = problem.two_sided;
  all.insert(all.end(), rows.begin(), rows.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return problem;
}

/// Whether the doubles q satisfy all rows without rounding, those held with equality, and no multiplier is
/// negative: then ||q - q*||_A <= ||Aq - z - Uᵀlambda||_(A⁻¹), however the rows depend on each other.
bool is_kept_exactly(const HeldRows& held) {
  const NearestPointProblem& problem = held.problem;
  const HeldPoint& point = held.point;
  for (std::size_t r = 0; r < held.rows.size(); ++r) {
    const auto k = static_cast<Index>(r);
    if (!problem.is_two_sided(held.rows[r]) && !(below(point.lambda[k] + point.dlambda[k]) >= 0))
      return false;
  }
  const std::vector<bool> is_held = marked(problem.rows(), held.rows);
  std::vector<Index> others;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!is_held[at(a)]) others.push_back(a);
  return slacks_if_kept(problem, point.q, held.rows, others).has_value();
}

/// The bound from the working set, when they stand alone and push; idle rows are let go so many times.
std::optional<double> bound_from(const NearestPointProblem& problem, const RadiiOf& radii,
                                 const Preconditioned& P, const Solution& solution, const Guess& guess,
                                 int rounds = 4) {
  const auto held = hold(problem, radii, P, guess.rows, solution.q, guess.lambda);
  if (!held) return std::nullopt;
  // Rows without a multiplier, for all that doubles tell, need not be held.
  const std::vector<Index> pushing = without_idle_rows(*held);
  if (pushing.size() < held->rows.size())
    return rounds > 0 ? bound_from(problem, radii, P, solution, {pushing, guess.lambda}, rounds - 1)
                      : std::nullopt;
  if (!radii.any() && is_kept_exactly(*held)) return unbalanced_above(*held);
  if (!multipliers_are_positive(*held)) return std::nullopt;
  const auto shift = shift_of_open_rows(*held);
  if (!shift) return std::nullopt;
  return above(length_above(P, radii, held->point.dq) + held->point.radius + *shift);
}

/// Open rows that are independent of each other and of the working set.
std::vector<Index> more_rows(const HeldRows& held) {
  const std::vector<OpenRow> open = HeldSlacks(held).open(0);
  if (open.empty()) return {};
  Matrix V(held.P.dimension(), static_cast<Index>(open.size()));
  for (std::size_t k = 0; k < open.size(); ++k) {
    Vector v = held.P.times_X(held.problem.U.row(open[k].row));
    v.normalize();
    if (held.U.rows() > 0)
      for (int pass = 0; pass < 2; ++pass) v -= held.Z * (held.Z.transpose() * v);
    constexpr double dependent = 1e-8;
    V.col(static_cast<Index>(k)) = v.norm() > dependent ? v : Vector::Zero(v.size());
  }
  const linear_algebra::PivotedQr factor(V);
  std::vector<Index> found;
  for (Index r = 0; r < factor.rank; ++r)
    found.push_back(open[at(factor.order[static_cast<std::size_t>(r)])].row);
  return found;
}

/// The bound where rows of the working set and open are equalities in disguise: these are held, with
/// multipliers of any sign.
std::optional<double> bound_with_disguised(const NearestPointProblem& problem, const RadiiOf& radii,
                                           const Preconditioned& P, const Solution& solution, Guess guess) {
  if (radii.any()) return std::nullopt;
  const auto held = hold(problem, radii, P, guess.rows, solution.q, guess.lambda);
  if (!held) return std::nullopt;
  const std::vector<Index> more = more_rows(*held);
  guess.rows.insert(guess.rows.end(), more.begin(), more.end());
  const auto all = hold(problem, radii, P, guess.rows, solution.q, guess.lambda);
  if (!all) return std::nullopt;
  const std::vector<Index> rows = disguised(*all);
  if (rows.empty()) return std::nullopt;
  return bound_from(with_equalities(problem, rows), radii, P, solution, guess);
}

/// The bound, for every problem within the radii.
std::optional<double> bound_within(const NearestPointProblem& problem, const Solution& solution,
                                   const RadiiOf& radii) {
  if (!is_ordinary_problem(problem, solution)) return std::nullopt;
  const Guess active{solution.basis.empty() ? loaded_rows(solution) : solution.basis, solution.lambda};
  if (!is_dense_size(problem, active.rows.size())) {
    const auto bound = sparse_enclosed_error(problem, radii, solution, active.rows);
    return bound ? bound : sparse_kept_error(problem, radii, solution);
  }
  const auto P = preconditioned(problem.A, radii);
  if (!P || !(P->delta < 0.5)) return std::nullopt;
  auto bound = bound_from(problem, radii, *P, solution, active);
  if (!bound) bound = bound_with_disguised(problem, radii, *P, solution, active);
  if (!bound)
    if (const auto chosen = independent(problem, solution))
      bound = bound_from(problem, radii, *P, solution, *chosen);
  const auto kept = residual_of_kept_point(problem, radii, solution);
  if (!kept) return bound;
  const double of_kept = dual_length_above(*P, kept->r1, kept->r1_radius);
  return bound && *bound <= of_kept ? bound : of_kept;
}

}  // namespace

std::optional<double> enclosed_error(const NearestPointProblem& problem, const Solution& solution) {
  return bound_within(problem, solution, RadiiOf(nullptr));
}

std::optional<double> enclosed_error(const NearestPointProblem& problem, const EntryRadii& radii,
                                     const Solution& solution) {
  if (!radii.is_finite()) return std::nullopt;
  const EntryRadii usable = ordinary(radii);
  return bound_within(problem, solution, RadiiOf(usable.is_zero() ? nullptr : &usable));
}

}  // namespace convex::inline proof
