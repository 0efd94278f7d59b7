#include "convex/nearest_point/sparse/interior_point_start.hpp"

#include <cmath>

#include "convex/nearest_point/solve_watch.hpp"

namespace convex::inline sparse {
namespace {

/// Added to 1/weight, so that systems stay solvable where slacks vanish (relative to rows of length 1).
constexpr double regularisation = 1e-9;

/// The weight of the violations in the first system, which takes A as seriously as the rows, as long as
/// they are not many in series. With stiff rows the multipliers of those that cannot persist would be huge.
constexpr double first_weight = 100;

/// Slacks begin no smaller than this part of the violations of the free motion (root mean square); nothing
/// begins below the other, in the scaled units.
constexpr double part_of_free = 0.1, smallest = 1e-3;

/// Where no active set follows, rows as springs begin no nearer to the boundary than so many times the usual
/// sizes, for there the first steps are short.
constexpr double well_inside = 10;

/// Of rows of the working set as they were in a problem like this one: one over the weight; the slowest
/// corrections that are trusted; the part of what is asked to which they go on, and at most how many; the
/// part of the multipliers' size that products begin with where some rows stay wrong.
constexpr double held_delta = 1e-6, slowest_held = 0.5, part_of_asked = 0.1, part_of_size = 1e-5;
constexpr int most_corrections = 10;

/// The equations are met well enough for a look at the rows when this part of the first residual is left.
constexpr double part_left = 0.1;

/// A part of the way to the boundary.
constexpr double short_of_boundary = 0.995;

constexpr Index most_steps = 200;
/// Steps shorter than this, so many in turn, lead nowhere.
constexpr double short_step = 1e-3;
constexpr int patience = 4;
/// Where multipliers and slacks complement each other as well as this part of the gap asked for, and rows are
/// not met all the same, they never will be.
constexpr double hopeless = 1e-6;
/// Multipliers beyond this belong to rows that contradict each other.
constexpr double largest_multiplier = 1e10;

double root_mean_square(const Vector& x) {
  return x.size() > 0 ? x.norm() / std::sqrt(static_cast<double>(x.size())) : 0;
}

}  // namespace

InteriorPointStart::InteriorPointStart(const BalancedProblem& problem, RowSystem& system, const Vector& free)
    : problem_(problem),
      system_(system),
      step_(problem.two_sided),
      weight_(Vector::Ones(problem.s.size())),
      side_(static_cast<std::size_t>(problem.s.size()), true),
      usual_slack_(std::max(smallest, part_of_free * root_mean_square(problem.U * free - problem.s))) {}

/// Rows as springs: what they push and how far they open tell the sizes of multipliers and slacks, and
/// nothing starts below its usual size.
void InteriorPointStart::start() {
  started_ = true;
  held_ = false;
  weight_.setConstant(first_weight);
  if (!system_.factor(weight_)) return;
  at_.q = system_.solve(problem_.z + problem_.U.transpose() * weight_.cwiseProduct(problem_.s));
  at_.slack = problem_.U * at_.q - problem_.s;
  at_.lambda = -first_weight * at_.slack;
  const double push = std::max(smallest, root_mean_square(at_.lambda.cwiseMax(0)));
  const double open = std::max(usual_slack_, root_mean_square(at_.slack.cwiseMax(0)));
  const double inside = stands_alone_ ? well_inside : 1;
  for (Index a = 0; a < at_.slack.size(); ++a) {
    if (one_sided(a)) at_.lambda[a] = std::max(0.0, at_.lambda[a]) + inside * push;
    at_.slack[a] = one_sided(a) ? std::max(0.0, at_.slack[a]) + inside * open : 0;
  }
}

void InteriorPointStart::stand_alone(Index limit) {
  stands_alone_ = true;
  limit_ = limit;
}

/// A correction towards U q = s on the rows that look active, with multipliers of 0 on the others; its size.
double InteriorPointStart::hold_active_rows() {
  bool is_same = held_;
  for (Index a = 0; a < weight_.size(); ++a) {
    const double weight = looks_active(a) ? 1 / held_delta : 0;
    is_same = is_same && weight == weight_[a];
    weight_[a] = weight;
    if (weight == 0) at_.lambda[a] = 0;
  }
  held_ = is_same || system_.factor(weight_);
  if (!held_) return infinity;
  const Vector rest = problem_.z - problem_.A * at_.q + problem_.U.transpose() * at_.lambda;
  const Vector miss = problem_.s - problem_.U * at_.q;
  const Vector dq = system_.solve(rest + problem_.U.transpose() * weight_.cwiseProduct(miss));
  at_.q += dq;
  at_.slack = problem_.U * at_.q - problem_.s;
  at_.lambda -= weight_.cwiseProduct(at_.slack);
  corrected_same_ = is_same;
  return std::sqrt(std::max(0.0, dq.dot(problem_.A * dq)));
}

/// Pairs of multiplier and slack with the same difference and this product (Chen and Harker 1993).
void InteriorPointStart::centre(double product) {
  for (Index a = 0; a < at_.lambda.size(); ++a) {
    if (!one_sided(a)) {
      at_.slack[a] = 0;
      continue;
    }
    const double half = 0.5 * (at_.lambda[a] - at_.slack[a]), root = std::sqrt(half * half + product);
    at_.lambda[a] = half >= 0 ? root + half : product / (root - half);
    at_.slack[a] = half >= 0 ? product / (root + half) : root - half;
  }
}

double InteriorPointStart::start_near(const Vector& q, const Vector& lambda, double part) {
  at_ = {q, problem_.U * q - problem_.s, lambda};
  const InteriorPointState given = at_;
  const double size = root_mean_square(lambda), length = std::max(1.0, q.norm());
  Index fewest = lambda.size() + 1;
  double last = infinity;
  for (int k = 0; k < most_corrections; ++k) {
    const double correction = hold_active_rows();
    Index wrong = 0;
    double square = 0;
    for (Index a = 0; a < lambda.size(); ++a) {
      const double miss = weight_[a] > 0 ? at_.lambda[a] : at_.slack[a];
      if (!one_sided(a) || miss >= 0) continue;
      ++wrong;
      square += miss * miss;
    }
    if (!(std::sqrt(square / step_.count()) <= size)) return infinity;
    started_ = began_near_ = true;
    // With the same rows each correction is smaller by the same factor.
    if (wrong == 0 && corrected_same_ && correction < slowest_held * last) {
      const double left = correction * correction / last / (1 - slowest_held) + 4 * unit_roundoff * length;
      if (left <= part_of_asked * part * length) return left;
    }
    last = correction;
    if (wrong > 0 && wrong >= fewest) break;
    if (wrong > 0) fewest = wrong;
  }
  at_ = given;
  const Vector rest = problem_.z - problem_.A * q + problem_.U.transpose() * lambda;
  const double miss = std::max(root_mean_square(rest), root_mean_square(lambda.cwiseMin(at_.slack)));
  centre(std::max(miss * miss, part_of_size * size));
  return infinity;
}

/// lambda dslack + slack dlambda = target, U dq - dslack = primal_rest, A dq - Uᵀdlambda = dual_rest.
void InteriorPointStart::solve(const Vector& dual_rest, const Vector& primal_rest, const Vector& target,
                               InteriorPointState& to) const {
  Vector push(target.size());
  for (Index a = 0; a < target.size(); ++a)
    push[a] = weight_[a] * ((one_sided(a) ? target[a] / at_.lambda[a] : 0) + primal_rest[a]);
  to.q = system_.solve(dual_rest + problem_.U.transpose() * push);
  to.lambda = push - weight_.cwiseProduct(problem_.U * to.q);
  to.slack.resize(target.size());
  for (Index a = 0; a < target.size(); ++a)
    to.slack[a] = one_sided(a) ? (target[a] - at_.slack[a] * to.lambda[a]) / at_.lambda[a] : 0;
}

Index InteriorPointStart::changes_of_sides() {
  Index changes = 0;
  for (Index a = 0; a < at_.lambda.size(); ++a) {
    const auto k = at(a);
    if (side_[k] == looks_active(a)) continue;
    side_[k] = !side_[k];
    ++changes;
  }
  return changes;
}

InteriorPointStart::End InteriorPointStart::approach(double gap, bool until_steady) {
  if (!started_) start();
  const Index m = at_.lambda.size();
  int idle = 0;
  for (Index k = 0; k < most_steps; ++k) {
    const Vector dual_rest = problem_.z - problem_.A * at_.q + problem_.U.transpose() * at_.lambda;
    const Vector primal_rest = problem_.s - problem_.U * at_.q + at_.slack;
    const double mean = step_.mean(at_);
    const double rest = std::max(primal_rest.cwiseAbs().maxCoeff(), dual_rest.cwiseAbs().maxCoeff());
    if (mean <= gap && rest <= std::sqrt(gap)) return End::close;
    if (k == 0) first_rest_ = rest;
    if (changes_of_sides() == 0 && until_steady && k > 0 && rest <= part_left * first_rest_)
      return End::steady;
    if (at_.lambda.cwiseAbs().maxCoeff() > largest_multiplier || mean <= hopeless * gap)
      return End::unbounded;
    if (limit_ > 0 && steps_ >= limit_) return End::stalled;
    held_ = false;
    for (Index a = 0; a < m; ++a)
      weight_[a] = 1 / ((one_sided(a) ? at_.slack[a] / at_.lambda[a] : 0) + regularisation);
    if (!system_.factor(weight_)) return End::stalled;
    const double step = step_.take(at_, short_of_boundary, [&](const Vector& target, InteriorPointState& to) {
      solve(dual_rest, primal_rest, target, to);
    });
    ++steps_;
    SolveWatch::tell("sparse-active-set", steps_);
    idle = step < short_step ? idle + 1 : 0;
    if (idle > patience || !at_.q.allFinite() || !at_.lambda.allFinite()) return End::stalled;
  }
  return End::stalled;
}

}  // namespace convex::inline sparse
