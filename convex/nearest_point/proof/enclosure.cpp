#include "convex/nearest_point/proof/enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/linear_algebra/pivoted_qr.hpp"
#include "convex/nearest_point/cone_projection.hpp"
#include "convex/nearest_point/proof/exact_dependence.hpp"
#include "convex/nearest_point/proof/held_point.hpp"
#include "convex/nearest_point/proof/open_rows.hpp"
#include "convex/nearest_point/proof/sparse_enclosure.hpp"

namespace convex {
namespace {

/// Dense matrices of X and of the active rows are made up to these sizes.
constexpr Index largest_dimension = 1500, most_active_entries = largest_dimension * largest_dimension;

bool multipliers_are_positive(const NearestPointProblem& problem, const std::vector<Index>& rows,
                              const HeldPoint& point) {
  std::vector<bool> two_sided(static_cast<std::size_t>(problem.rows()), false);
  for (Index a : problem.two_sided) two_sided[static_cast<std::size_t>(a)] = true;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (two_sided[static_cast<std::size_t>(rows[r])]) continue;
    const auto k = static_cast<Index>(r);
    if (!(below(point.lambda[k] + point.dlambda[k]) > above(point.multiplier_radius[k]))) return false;
  }
  return true;
}

/// What is known of the slacks of rows that are not held.
class Slacks {
 public:
  Slacks(const NearestPointProblem& problem, const RadiiOf& radii, const Preconditioned& P,
         const std::vector<Index>& rows, const HeldPoint& point)
      : problem_(problem),
        radii_(radii),
        point_(point),
        held_(static_cast<std::size_t>(problem.rows()), false) {
    for (Index a : rows) held_[static_cast<std::size_t>(a)] = true;
    // |v_i| <= ||v||_A sqrt((A⁻¹)_ii), and A⁻¹ = Xᵀ A'⁻¹ X.
    const Index n = P.dimension();
    per_length_.resize(n);
    for (Index i = 0; i < n; ++i) per_length_[i] = P.is_diagonal ? std::abs(P.x[i]) : norm_above(P.X.col(i));
    per_length_ *= above(1 / std::sqrt(below(1 - P.delta)));
    size_ = above(1) * (point.q.cwiseAbs() + point.dq.cwiseAbs());
  }

  /// The rows whose slack may be gone, and all two-sided ones, when the held point moves by `reach` in
  /// ||·||_A.
  std::vector<OpenRow> open(double reach) const {
    const Index n = problem_.dimension();
    const Vector hidden = above(1) * (point_.radius + reach) * per_length_;
    const Vector loose = gamma(n + 1) * point_.q.cwiseAbs() + above(1) * point_.dq.cwiseAbs() + hidden;
    std::vector<OpenRow> found;
    Vector row(n);
    for (Index a = 0; a < problem_.rows(); ++a) {
      if (held_[static_cast<std::size_t>(a)]) continue;
      problem_.U.copy_row(a, row);
      const double s = problem_.s[a];
      const double uncertain = above(radii_.s(a) + radii_.row_times(a, size_ + hidden));
      const bool is_two_sided = std::binary_search(problem_.two_sided.begin(), problem_.two_sided.end(), a);
      if (!is_two_sided &&
          row.dot(point_.q) - s > above(row.cwiseAbs().dot(loose) + gamma(n + 1) * std::abs(s) + uncertain))
        continue;
      CompensatedSum sum;
      sum.add(-s, 1);
      for (Index i = 0; i < n; ++i) {
        sum.add(row[i], point_.q[i]);
        sum.add(row[i], point_.dq[i]);
      }
      const Enclosed slack = sum.result();
      const double still = above(slack.radius + row.cwiseAbs().dot(hidden) + uncertain);
      if (!is_two_sided && below(slack.value) > still) continue;
      // At the held point itself.
      const double off =
          above(slack.radius + row.cwiseAbs().dot(Vector(point_.radius * per_length_)) + uncertain);
      found.push_back({a, above(std::max(0.0, off - slack.value))});
    }
    return found;
  }

 private:
  const NearestPointProblem& problem_;
  const RadiiOf& radii_;
  const HeldPoint& point_;
  std::vector<bool> held_;
  Vector per_length_, size_;
};

/// Whether a row is exactly implied by rows held at which doubles find it to be one of their combinations.
bool follows(const NearestPointProblem& problem, const RadiiOf& radii, const Preconditioned& P,
             const Active& active, const std::vector<Index>& held, Index a) {
  constexpr double noticeable = 1e-9;
  constexpr std::size_t most_others = 60;
  if (radii.any()) return false;
  const Vector c = coefficients_on_held(P, active, problem.U.row(a));
  std::vector<Index> others;
  for (Index r = 0; r < c.size(); ++r)
    if (std::abs(c[r]) > noticeable * c.cwiseAbs().maxCoeff())
      others.push_back(held[static_cast<std::size_t>(r)]);
  return others.size() <= most_others && follows_exactly(problem, a, others);
}

/// At least ||q* - q_W||_A: 0 where every other slack is positive, or exactly implied not to be negative.
std::optional<double> shift_of_open_rows(const NearestPointProblem& problem, const RadiiOf& radii,
                                         const Preconditioned& P, const Active& active,
                                         const std::vector<Index>& held, const HeldPoint& point) {
  const Slacks slacks(problem, radii, P, held, point);
  std::vector<OpenRow> open = slacks.open(0);
  const auto is_two_sided = [&](const OpenRow& row) {
    return std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), row.row);
  };
  if (std::all_of(open.begin(), open.end(),
                  [&](const OpenRow& row) { return follows(problem, radii, P, active, held, row.row); }))
    return 0;
  // Rows that the motion may reach are counted as open, until no other is reached.
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    if (std::any_of(open.begin(), open.end(), is_two_sided)) return std::nullopt;
    const auto bound = bound_with_open_rows(problem, radii, P, active, held, point, open);
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

/// The rows with a multiplier, when they are few enough to be independent.
std::vector<Index> loaded_rows(const Solution& solution) {
  std::vector<Index> rows;
  for (Index a = 0; a < solution.lambda.size(); ++a)
    if (solution.lambda[a] != 0) rows.push_back(a);
  return rows;
}

/// Rows to hold, with multipliers, not all of those given need be: independent ones that push just as the
/// rows with a multiplier do together (Lawson and Hanson's method ends at such rows), the two-sided ones
/// among them.
struct Held {
  std::vector<Index> rows;
  Vector lambda;
};

/// Independent rows, among those without slack, that make R = A q - z (Lawson and Hanson's method ends at
/// such rows), and as many of the two-sided rows as are independent.

std::optional<Held> independent(const NearestPointProblem& problem, const Solution& solution) {
  const auto whitened = [&](const std::vector<Index>& rows) {
    Matrix V(problem.dimension(), static_cast<Index>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) problem.U.copy_row(rows[r], V.col(static_cast<Index>(r)));
    problem.A.whiten_in_place(V);
    return V;
  };
  std::vector<Index> rows;
  if (!problem.two_sided.empty()) {
    const linear_algebra::PivotedQr factor(whitened(problem.two_sided));
    for (Index r = 0; r < factor.rank; ++r)
      rows.push_back(problem.two_sided[static_cast<std::size_t>(factor.order[static_cast<std::size_t>(r)])]);
  }
  const std::size_t two_sided = rows.size();
  std::vector<Index> free(two_sided);
  std::iota(free.begin(), free.end(), Index{0});
  constexpr double tight = 1e-9;
  const Vector slack = problem.U.times(solution.q) - problem.s;
  for (Index a = 0; a < problem.rows(); ++a)
    if (std::abs(slack[a]) <=
            tight * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, solution.q.cwiseAbs())) &&
        !std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), a))
      rows.push_back(a);
  const Vector force = problem.A.multiply(solution.q) - problem.z;
  const ConeProjection push = cone_projection(whitened(rows), problem.A.whiten(force), free);
  if (!push.finished) return std::nullopt;
  Held held{{}, Vector::Zero(problem.rows())};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double lambda = push.lambda[static_cast<Index>(r)];
    if (lambda == 0 && r >= two_sided) continue;
    held.rows.push_back(rows[r]);
    held.lambda[rows[r]] = lambda;
  }
  return held;
}

/// Drops one-sided rows whose multiplier at the refined point is 0 but for its radius, if there are such.
bool drop_idle_rows(const NearestPointProblem& problem, const HeldPoint& point, Held& held) {
  std::vector<Index> kept;
  for (std::size_t r = 0; r < held.rows.size(); ++r) {
    const auto k = static_cast<Index>(r);
    const bool two_sided =
        std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), held.rows[r]);
    if (two_sided || !(std::abs(point.lambda[k] + point.dlambda[k]) <= above(point.multiplier_radius[k])))
      kept.push_back(held.rows[r]);
  }
  const bool dropped = kept.size() < held.rows.size();
  held.rows = std::move(kept);
  return dropped;
}

/// Whether dense matrices of X and of so many rows may be made.
bool is_dense_size(const NearestPointProblem& problem, std::size_t rows) {
  const bool is_diagonal =
      problem.A.kind() == MetricKind::diagonal || problem.A.kind() == MetricKind::identity;
  return (problem.dimension() <= largest_dimension || is_diagonal) &&
         static_cast<Index>(rows) * problem.dimension() <= most_active_entries;
}

bool is_ordinary_problem(const NearestPointProblem& problem, const Solution& solution) {
  if (solution.q.size() != problem.dimension() || !is_ordinary(problem.z) || !is_ordinary(problem.s) ||
      !is_ordinary(solution.q) || !is_ordinary(solution.lambda))
    return false;
  return problem.U.is_sparse() ? is_ordinary(Eigen::Map<const Vector>(problem.U.sparse().valuePtr(),
                                                                      problem.U.sparse().nonZeros()))
                               : is_ordinary(problem.U.dense());
}

/// The bound from the rows held, when they stand alone and push.
std::optional<double> bound_from(const NearestPointProblem& problem, const RadiiOf& radii,
                                 const Preconditioned& P, const Solution& solution, Held held) {
  const auto stand_alone = [](const std::optional<Active>& rows) { return rows && rows->delta < 0.5; };
  auto active = active_rows(problem, radii, P, held.rows);
  if (!stand_alone(active)) return std::nullopt;
  HeldPoint point = held_point(problem, radii, P, *active, held.rows, solution.q, held.lambda);
  // Rows without a multiplier, for all that doubles tell, need not be held.
  if (drop_idle_rows(problem, point, held)) {
    active = active_rows(problem, radii, P, held.rows);
    if (!stand_alone(active)) return std::nullopt;
    point = held_point(problem, radii, P, *active, held.rows, solution.q, held.lambda);
  }
  if (!std::isfinite(point.radius) || !multipliers_are_positive(problem, held.rows, point))
    return std::nullopt;
  const auto shift = shift_of_open_rows(problem, radii, P, *active, held.rows, point);
  if (!shift) return std::nullopt;
  return above(length_above(P, radii, point.dq) + point.radius + *shift);
}

/// The bound, for every problem within the radii.
std::optional<double> bound_within(const NearestPointProblem& problem, const Solution& solution,
                                   const RadiiOf& radii) {
  if (!is_ordinary_problem(problem, solution)) return std::nullopt;
  Held held{solution.basis.empty() ? loaded_rows(solution) : solution.basis, solution.lambda};
  if (!is_dense_size(problem, held.rows.size()))
    return sparse_enclosed_error(problem, radii, solution, held.rows);
  const auto P = preconditioned(problem.A, radii);
  if (!P || !(P->delta < 0.5)) return std::nullopt;
  if (auto bound = bound_from(problem, radii, *P, solution, std::move(held))) return bound;
  auto chosen = independent(problem, solution);
  return chosen ? bound_from(problem, radii, *P, solution, std::move(*chosen)) : std::nullopt;
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

}  // namespace convex
