#include "mechanics/units.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics {
namespace {

using convex::Status;

/// Numbers between this and its inverse can be squared and divided by each other a few times over.
constexpr double largest_ordinary = 0x1p80;

bool is_ordinary(double x) { return !(x > 0) || (x <= largest_ordinary && x >= 1 / largest_ordinary); }

/// A power of four near x, so that its root is exact as well, and its inverse is finite; 1 when x is 0.
double power_near(double x) {
  if (!(x > 0)) return 1;
  constexpr int most = 1000;
  int exponent = most;
  if (std::isfinite(x)) std::frexp(x, &exponent);
  exponent = std::clamp(exponent, -most, most);
  return std::ldexp(1, exponent - (exponent & 1));
}

double largest(const Vector& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0; }

double largest(const convex::ConstraintRows& U) {
  if (!U.is_sparse()) return U.dense().size() > 0 ? U.dense().cwiseAbs().maxCoeff() : 0;
  double found = 0;
  for (Index k = 0; k < U.sparse().nonZeros(); ++k)
    found = std::max(found, std::abs(U.sparse().valuePtr()[k]));
  return found;
}

/// The largest of what rows ask for: a one-sided row asks for nothing where s is negative.
double largest_asked(const convex::NearestPointProblem& problem) {
  double found = problem.s.size() > 0 ? std::max(0.0, problem.s.maxCoeff()) : 0;
  for (convex::Index a : problem.two_sided) found = std::max(found, std::abs(problem.s[a]));
  return found;
}

/// x / first / second, units: powers of 2 whose product or quotients may leave the range.
Vector divided(const Vector& x, double first, double second) {
  const int power = -std::ilogb(first) - std::ilogb(second);
  return x.unaryExpr([&](double entry) { return std::ldexp(entry, power); });
}

convex::ConstraintRows divided(const convex::ConstraintRows& U, double unit) {
  if (U.is_sparse()) return convex::ConstraintRows(convex::SparseRows(U.sparse() / unit));
  return convex::ConstraintRows(convex::RowMatrix(U.dense() / unit));
}

}  // namespace

Units fit_units(const convex::NearestPointProblem& problem) {
  const double mass = largest(problem.A.diagonal()), gradient = largest(problem.U);
  const double force = largest(problem.z), bound = largest(problem.s);
  if (is_ordinary(mass) && is_ordinary(gradient) && is_ordinary(force) && is_ordinary(bound)) return {};
  Units units{power_near(mass), 1, power_near(gradient)};
  // Of masses too far apart, the least would be 0.
  if (mass > 0 && problem.A.diagonal().minCoeff() / units.mass < std::numeric_limits<double>::min())
    units.mass = 1;
  // A bound that is none need not be near 1: it is to stay a double.
  constexpr double far = 0x1p-900;
  const double asked = std::max(force / units.mass, largest_asked(problem) / units.gradient);
  units.acceleration = power_near(std::max(asked, (asked > 0 ? far : 1) * (bound / units.gradient)));
  return units;
}

convex::NearestPointProblem in_units(const convex::NearestPointProblem& problem, const Units& units) {
  convex::NearestPointProblem scaled{problem.A.scaled(1 / units.mass),
                                     divided(problem.z, units.acceleration, units.mass),
                                     divided(problem.U, units.gradient),
                                     divided(problem.s, units.acceleration, units.gradient),
                                     problem.two_sided,
                                     problem.radii};
  if (scaled.radii) {
    scaled.radii->row *= std::sqrt(units.mass) / units.gradient;
    scaled.radii->s /= units.gradient * units.acceleration;
  }
  return scaled;
}

bool are_exact(const convex::NearestPointProblem& problem, const Units& units,
               const convex::NearestPointProblem& scaled) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == 0 || (x.array() == y.array()).all();
  };
  const convex::NearestPointProblem back = in_units(scaled, units.inverse());
  return same(problem.s, back.s) && (problem.U.is_sparse() || same(problem.U.dense(), back.U.dense()));
}

void restore_units(GaussSolution& solution, const Units& units, double tolerance) {
  const double force = units.mass * units.acceleration, multiplier = force / units.gradient;
  const double norm = units.norm();
  convex::Solution& primal = solution.primal;
  primal.q *= units.acceleration;
  primal.lambda *= multiplier;
  primal.slack *= units.gradient * units.acceleration;
  primal.error_bound *= norm;
  primal.acceleration_norm *= norm;
  primal.force_norm *= norm;
  solution.multipliers.least_norm *= multiplier;
  if (solution.multipliers.ranges)
    for (convex::Interval& range : *solution.multipliers.ranges) {
      range.low *= multiplier;
      range.high *= multiplier;
    }
  solution.reaction *= force;
  solution.gauss *= force * units.acceleration;
  solution.hypothesis.two_sided.acceleration *= units.acceleration;
  solution.hypothesis.two_sided.multipliers *= multiplier;
  if (solution.hypothesis.drop_negative_acceleration)
    *solution.hypothesis.drop_negative_acceleration *= units.acceleration;
  if (solution.from_dual) {
    solution.from_dual->reaction *= force;
    solution.from_dual->apex_norm *= norm;
    solution.from_dual->apex_missed *= norm;
  }
  if (primal.status != Status::solved && primal.status != Status::inaccurate) return;
  if (!primal.q.allFinite() || !primal.lambda.allFinite() || !std::isfinite(primal.acceleration_norm))
    primal.error_bound = std::numeric_limits<double>::infinity();
  const bool close = primal.error_bound <= tolerance * std::max(1.0, primal.acceleration_norm);
  primal.status = close && std::isfinite(primal.error_bound) ? Status::solved : Status::inaccurate;
}

Vector row_units(const convex::NearestPointProblem& problem) {
  Vector units = Vector::Ones(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a) {
    double largest = 0;
    problem.U.for_each_entry(a, [&](Index, double u) { largest = std::max(largest, std::abs(u)); });
    if (is_ordinary(largest)) continue;
    const double unit = std::ldexp(1, std::clamp(std::ilogb(largest), -1000, 1000));
    const double s = std::abs(problem.s[a]) / unit;
    if (s == 0 ? problem.s[a] == 0 : s <= std::numeric_limits<double>::max()) units[a] = unit;
  }
  return units;
}

convex::NearestPointProblem in_row_units(convex::NearestPointProblem problem, const Vector& units) {
  const auto inverse = units.cwiseInverse().asDiagonal();
  problem.U = problem.U.is_sparse() ? convex::ConstraintRows(convex::SparseRows(inverse * problem.U.sparse()))
                                    : convex::ConstraintRows(convex::RowMatrix(inverse * problem.U.dense()));
  problem.s = problem.s.cwiseQuotient(units);
  if (problem.radii)
    problem.radii =
        convex::DataRadii{problem.radii->row.cwiseQuotient(units), problem.radii->s.cwiseQuotient(units)};
  return problem;
}

GaussSolution in_row_units(GaussSolution solution, const Vector& units) {
  const auto scale = [&](Vector& multipliers) {
    if (multipliers.size() == units.size()) multipliers = multipliers.cwiseProduct(units);
  };
  scale(solution.primal.lambda);
  scale(solution.multipliers.least_norm);
  scale(solution.hypothesis.two_sided.multipliers);
  Vector& w = solution.primal.farkas;
  scale(w);
  if (w.size() > 0 && w.cwiseAbs().maxCoeff() > 0) w /= std::exp2(std::ilogb(w.cwiseAbs().maxCoeff()));
  if (solution.primal.slack.size() == units.size())
    solution.primal.slack = solution.primal.slack.cwiseQuotient(units);
  return solution;
}

}  // namespace mechanics
