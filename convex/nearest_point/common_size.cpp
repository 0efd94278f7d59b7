#include "convex/nearest_point/common_size.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/infinity.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "convex/nearest_point/reductions/scaled_problem.hpp"

namespace convex {
namespace {

/// In common size, products of three numbers up to this, or down to its inverse, are doubles.
constexpr double largest_of_common_size = 0x1p300;

/// A row that asks for less than minus so many times what others ask for is left out, and looked at again at
/// the end.
constexpr double out_of_sight = 0x1p60;

/// A power of four near x, so that its root is one of two, and its inverse is finite; 1 for 0.
double power_near(double x) {
  constexpr int most = 1000;
  if (!(x > 0)) return 1;
  int exponent = most;
  if (std::isfinite(x)) std::frexp(x, &exponent);
  exponent = std::clamp(exponent, -most, most);
  return std::ldexp(1, exponent - (exponent & 1));
}

/// Whether a number that is `scaled` in common size counts there as it should. Within radii a small one is as
/// good as 0.
bool counts(double original, double scaled, bool may_vanish) {
  if (original == 0) return true;
  const double size = std::abs(scaled);
  return size <= largest_of_common_size && (may_vanish || size >= 1 / largest_of_common_size);
}

}  // namespace

bool has_ordinary_numbers(const NearestPointProblem& problem) {
  const bool rows = problem.U.is_sparse() ? exact_arithmetic::is_ordinary(problem.U.sparse().coeffs())
                                          : exact_arithmetic::is_ordinary(problem.U.dense());
  return rows && exact_arithmetic::is_ordinary(problem.A.diagonal()) &&
         exact_arithmetic::is_ordinary(problem.z) && exact_arithmetic::is_ordinary(problem.s);
}

CommonSize::CommonSize(const NearestPointProblem& original)
    : problem{original.A, original.z, {}, {}, {}, {}} {
  const Index m = original.rows();
  if (original.A.diagonal().size() > 0) {
    mass = power_near(original.A.diagonal().maxCoeff());
    // Of masses too far apart, the least would be 0.
    if (original.A.diagonal().minCoeff() / mass < std::numeric_limits<double>::min()) mass = 1;
  }
  if (mass != 1) problem.A = original.A.scaled(1 / mass);
  const Vector root = problem.A.diagonal().cwiseSqrt();
  Vector all_units(m), bound(m);
  // What the rows ask for, and z, as lengths of motions.
  double size = original.z.size() > 0 ? (original.z / mass).cwiseQuotient(root).cwiseAbs().maxCoeff() : 0;
  for (Index a = 0; a < m; ++a) {
    double length = 0;
    original.U.for_each_entry(a,
                              [&](Index i, double u) { length = std::max(length, std::abs(u) / root[i]); });
    all_units[a] = power_near(length);
    bound[a] = original.s[a] / all_units[a];
    const double asked = original.is_two_sided(a) ? std::abs(bound[a]) : bound[a];
    if (length > 0) size = std::max(size, asked);
    if (!(length > 0)) bound[a] = asked > 0 ? infinity : -infinity;  // a contradiction, or nothing
  }
  unit = power_near(size);
  for (Index a = 0; a < m; ++a)
    if (original.is_two_sided(a) || !(bound[a] < -out_of_sight * size)) rows.push_back(a);
  row_unit = all_units(rows);
  problem.U = divided(original.U, rows, row_unit);
  problem.s.resize(static_cast<Index>(rows.size()));
  const bool may_vanish = original.radii.has_value();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Index row = static_cast<Index>(k), a = rows[k];
    if (original.is_two_sided(a)) problem.two_sided.push_back(row);
    if (std::isinf(bound[a]) && original.s[a] != 0)
      row_unit[row] = power_near(std::abs(original.s[a]) / unit);
    problem.s[row] = original.s[a] / row_unit[row] / unit;
    is_ordinary = is_ordinary && counts(original.s[a], problem.s[row], may_vanish);
    original.U.for_each_entry(
        a, [&](Index, double u) { is_ordinary = is_ordinary && counts(u, u / row_unit[row], may_vanish); });
  }
  problem.z = original.z / mass / unit;
  for (Index i = 0; i < problem.z.size(); ++i)
    is_ordinary =
        is_ordinary && counts(original.z[i], problem.z[i], true) && counts(1, problem.A.diagonal()[i], false);
  if (!original.radii) return;
  problem.radii = select(original.radii, rows);
  problem.radii->row = (problem.radii->row * std::sqrt(mass)).cwiseQuotient(row_unit);
  problem.radii->s = problem.radii->s.cwiseQuotient(row_unit) / unit;
}

Solution CommonSize::restored(const NearestPointProblem& original, Solution found,
                              const Accuracy& accuracy) const {
  const Index m = original.rows();
  const double norm = std::sqrt(mass) * unit;
  const auto over_all = [&](const Vector& part) {
    Vector all = Vector::Zero(m);
    all(rows) = part;
    return all;
  };
  bool is_known = is_ordinary;
  for (Index& a : found.basis) a = rows[at(a)];
  for (LeftOutRow& out : found.model.left_out) out.row = rows[at(out.row)];
  if (found.farkas.size() > 0) {
    found.farkas = over_all(found.farkas.cwiseQuotient(row_unit));
    const double least = (found.farkas.array() != 0).select(found.farkas.cwiseAbs(), infinity).minCoeff();
    if (std::isfinite(least)) found.farkas /= power_near(least);
    // Weights so far apart that doubles do not hold them all prove nothing.
    is_known = found.farkas.allFinite() && (is_known || infeasibility_proof(original, found.farkas, false));
  }
  if (found.q.size() > 0) {
    const Vector size = found.q.cwiseAbs();
    std::vector<bool> kept = marked(m, rows);
    const Vector slack = found.slack;
    found.slack = original.U.times(found.q * unit) - original.s;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Index row = static_cast<Index>(k);
      found.slack[rows[k]] = slack[row] * unit * row_unit[row];
    }
    for (Index a = 0; a < m; ++a) {
      if (kept[at(a)]) continue;
      const double reached = original.U.absolute_dot(a, size) * unit;
      is_known = is_known && 2 * reached <= -original.s[a];
      if (!found.model.islands.empty()) found.model.left_out.push_back({a, LeftOutBecause::out_of_reach});
    }
    found.lambda = over_all((found.lambda * (mass * unit)).cwiseQuotient(row_unit));
    found.q *= unit;
    found.error_bound *= norm;
    found.rounding *= norm;
    found.acceleration_norm *= norm;
    found.force_norm *= norm;
    is_known = is_known && found.q.allFinite() && found.lambda.allFinite() && found.slack.allFinite();
  }
  std::sort(found.model.left_out.begin(), found.model.left_out.end(),
            [](const LeftOutRow& one, const LeftOutRow& other) { return one.row < other.row; });
  if (found.status == Status::solved && !found.is_within(accuracy)) found.status = Status::inaccurate;
  if (is_known) return found;
  if (found.status == Status::solved) found.status = Status::inaccurate;
  if (found.status == Status::infeasible) found.status = Status::gave_up;
  found.error_bound = infinity;
  found.undecided = open_question::range;
  return found;
}

namespace {

Solution in_own_size(const NearestPointProblem& problem, const Accuracy& accuracy,
                     Solution (*method)(const NearestPointProblem&, const Accuracy&)) {
  const CommonSize scaled(problem);
  return scaled.restored(problem, method(scaled.problem, accuracy), accuracy);
}

}  // namespace

Solution in_common_size(const NearestPointProblem& problem, const Accuracy& accuracy,
                        Solution (*method)(const NearestPointProblem&, const Accuracy&)) {
  if (has_ordinary_numbers(problem)) return method(problem, accuracy);
  validate(problem);
  return in_own_size(problem, accuracy, method);
}

bool is_beyond_squares(const NearestPointProblem& problem, const Solution& solution) {
  // The least, times the square of the rounding to doubles, has a square.
  constexpr double least = 0x1p-400, most = 0x1p480;
  if (solution.q.size() == 0) return false;
  const double q = solution.acceleration_norm, z = solution.force_norm;
  if (!(q < most && z < most)) return true;
  if (q > 0 || z > 0) return std::max(q, z) < least;
  return !problem.z.isZero(0) || !solution.q.isZero(0);
}

void take_own_size(const NearestPointProblem& problem, const Accuracy& accuracy,
                   Solution (*method)(const NearestPointProblem&, const Accuracy&), Solution& found) {
  Solution own = in_own_size(problem, accuracy, method);
  const auto is_told = [](const Solution& solution) {
    return solution.status == Status::solved || solution.status == Status::infeasible;
  };
  if (is_told(own) || !is_told(found)) found = std::move(own);
}

}  // namespace convex
