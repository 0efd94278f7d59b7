#include "mechanics/motion/tangent_chart.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/gauss_problem.hpp"
#include "mechanics/motion/held_rows.hpp"

namespace mechanics::inline motions {
namespace {

/// Newton's method has arrived when it moves a state by less than so many roundings of it.
constexpr double roundings_of_chart = 64;
constexpr int most_chart_corrections = 20;

HeldRows rows_held(const LagrangianSystem& system, const State& at, const std::vector<Index>& constraints,
                   const convex::Metric& A) {
  const convex::SparseRows U = system.contact_rows(at, constraints).U;
  std::vector<Vector> rows;
  for (Index a = 0; a < U.rows(); ++a) rows.push_back(Vector(U.row(a).transpose()));
  return HeldRows(A, rows);
}

}  // namespace

TangentChart::TangentChart(const LagrangianSystem& system, const State& near) : system_(system) {
  const auto m = static_cast<Index>(system.constraints().size()), n = near.q.size();
  for (Index a = 0; a < m; ++a)
    if (system.constraints()[static_cast<std::size_t>(a)].two_sided) two_sided_.push_back(a);
  origin_ = projected(near);
  if (two_sided_.empty()) {
    N_ = dual_ = convex::Matrix::Identity(n, n);
    return;
  }
  const convex::Metric A = kinetic_metric(system.inertia(origin_).A, system.coordinates());
  const HeldRows held = rows_held(system, origin_, two_sided_, A);
  const convex::SparseRows U = system.contact_rows(origin_, two_sided_).U;
  // Directions of the coordinates, without what the rows forbid, made orthonormal: the longest first.
  convex::Matrix rest(n, n);
  for (Index i = 0; i < n; ++i) {
    const Vector e = Vector::Unit(n, i);
    rest.col(i) = e + held.least_change(-(U * e));
  }
  const Index d = n - held.count();
  N_.resize(n, d);
  for (Index k = 0; k < d; ++k) {
    Index longest = 0;
    double length = -1;
    for (Index i = 0; i < n; ++i)
      if (const double size = A.norm(rest.col(i)); size > length) {
        length = size;
        longest = i;
      }
    Vector next = rest.col(longest) / length;
    for (int pass = 0; pass < 2; ++pass)
      for (Index j = 0; j < k; ++j) next -= A.inner(N_.col(j), next) * N_.col(j);
    next /= A.norm(next);
    N_.col(k) = next;
    for (Index i = 0; i < n; ++i) rest.col(i) -= A.inner(next, rest.col(i)) * next;
  }
  dual_.resize(d, n);
  for (Index k = 0; k < d; ++k) dual_.row(k) = A.multiply(N_.col(k)).transpose();
}

State TangentChart::projected(State at) const {
  if (two_sided_.empty()) return at;
  const auto rows = static_cast<Index>(two_sided_.size());
  double last = 0;
  for (int i = 0; i < most_chart_corrections; ++i) {
    const convex::Metric A = kinetic_metric(system_.inertia(at).A, system_.coordinates());
    const HeldRows held = rows_held(system_, at, two_sided_, A);
    const ConstraintRates rates = system_.constraint_rates(at);
    Vector f(rows), rate(rows);
    for (Index k = 0; k < rows; ++k) {
      f[k] = rates.f[two_sided_[static_cast<std::size_t>(k)]];
      rate[k] = rates.df[two_sided_[static_cast<std::size_t>(k)]];
    }
    const Vector dq = held.least_change(-f), dv = held.least_change(-rate);
    at.q += dq;
    at.v += dv;
    const double size = std::max(A.norm(dq) / std::max(A.norm(at.q), 1e-300),
                                 A.norm(dv) / std::max(A.norm(at.v) + A.norm(at.q), 1e-300));
    constexpr double nearly = 1e-10;  // from there on it turns about in roundings
    if (size <= roundings_of_chart * convex::unit_roundoff || (i > 1 && size < nearly && size > 0.5 * last))
      return at;
    last = size;
  }
  throw convex::InvalidInput(
      "the two-sided constraints cannot be brought to hold near a state on the way; they contradict each "
      "other there: stop before, with a smaller until");
}

Vector TangentChart::state_of(const Vector& y) const {
  const Index d = N_.cols(), n = N_.rows();
  const State there = projected({origin_.t, origin_.q + N_ * y.head(d), origin_.v + N_ * y.tail(d)});
  Vector x(2 * n);
  x << there.q, there.v;
  return x;
}

Vector TangentChart::along(const Vector& difference) const {
  const Index d = N_.cols(), n = N_.rows();
  Vector y(2 * d);
  y << dual_ * difference.head(n), dual_ * difference.tail(n);
  return y;
}

Vector TangentChart::direction(Index k) const {
  const Index d = N_.cols(), n = N_.rows();
  Vector x = Vector::Zero(2 * n);
  if (k < d)
    x.head(n) = N_.col(k);
  else
    x.tail(n) = N_.col(k - d);
  return x;
}

}  // namespace mechanics::inline motions
