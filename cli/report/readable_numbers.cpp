#include "cli/report/readable_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cli/report/contact_force.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;

/// The roundings that a sum of a few products collects.
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

/// What the error bound of an answer may add to that; a coarser answer is shown as it is.
constexpr double coarsest = 1e-12;

/// The rows of the first constraints: those of K as solved, the others as the system gives them.
convex::ConstraintRows rows_of(const Scene& scene, Index shown, Vector& s) {
  if (!scene.system) {
    s = scene.problem.s.head(shown);
    std::vector<Index> first(static_cast<std::size_t>(shown));
    std::iota(first.begin(), first.end(), Index{0});
    return scene.problem.U.select(first);
  }
  std::vector<Index> first(static_cast<std::size_t>(shown));
  std::iota(first.begin(), first.end(), Index{0});
  mechanics::ContactRows rows = scene.system->contact_rows(scene.state, first);
  s = rows.s;
  return convex::ConstraintRows(std::move(rows.U));
}

/// The largest size there is; beside one that is beyond doubles nothing is known to be rounding.
double scale_of(const convex::Solution& primal) {
  const double largest = std::max(primal.acceleration_norm, primal.force_norm);
  return std::isfinite(largest) ? largest : 0;
}

double error_of(const convex::Solution& primal) {
  const double scale = scale_of(primal);
  return std::clamp(primal.error_bound, rounding * scale, coarsest * scale);
}

}  // namespace

double without_rounding(double x, double scale) { return std::abs(x) <= rounding * scale ? 0 : x; }

Vector without_rounding(const SolvedScene& solved, Vector acceleration) {
  const convex::Metric& A = solved.scene.problem.A;
  const double largest = acceleration.size() > 0 ? acceleration.cwiseAbs().maxCoeff() : 0,
               error = error_of(solved.solution.primal);
  for (Index i = 0; i < acceleration.size(); ++i) {
    if (acceleration[i] == 0) continue;
    // Where all are that small, it is the error bound alone that tells.
    const double off = std::abs(acceleration[i]) > 1e-6 * largest
                           ? std::min(error, solved.solution.primal.error_bound)
                           : error;
    const Vector unit = Vector::Unit(A.dimension(), i);
    if (std::abs(acceleration[i]) <= off * A.dual_norm(unit)) acceleration[i] = 0;
  }
  return acceleration;
}

ReadableNumbers readable_numbers(const SolvedScene& solved, Index shown) {
  const Scene& scene = solved.scene;
  const convex::Metric& A = scene.problem.A;
  const convex::Solution& primal = solved.solution.primal;
  const double scale = scale_of(primal), error = error_of(primal);
  const Index n = std::min(shown, A.dimension());
  const auto m = std::min(shown, static_cast<Index>(scene.constraints.size()));
  ReadableNumbers read{without_rounding(solved, primal.q.head(n)),
                       solved.solution.reaction.head(n),
                       {},
                       {},
                       solved.second_rates.head(m),
                       scene.over_constraints(solved.solution.multipliers.least_norm).head(m),
                       std::vector<std::optional<double>>(static_cast<std::size_t>(m)),
                       {}};
  for (Index i = 0; i < n; ++i)
    if (std::abs(read.reaction[i]) <= error * std::sqrt(A.diagonal()[i])) read.reaction[i] = 0;
  Vector s;
  const convex::ConstraintRows rows = rows_of(scene, m, s);
  convex::DataRadii radii{Vector::Zero(m), Vector::Zero(m)};
  if (scene.written) {
    std::vector<Index> first(static_cast<std::size_t>(m));
    std::iota(first.begin(), first.end(), Index{0});
    radii = mechanics::row_radii(*scene.system, scene.state, scene.written->radii, first, A);
  }
  for (Index a = 0; a < m; ++a) {
    const Vector u = rows.row(a);
    const double length = A.dual_norm(u);
    if (std::abs(read.lambda[a]) * length <= error) read.lambda[a] = 0;
    if (read.lambda[a] != 0)
      if (const auto factor = force_per_multiplier(scene, a))
        read.forces[static_cast<std::size_t>(a)] = std::abs(read.lambda[a]) * *factor;
    // What opens was told from rounding before.
    if (solved.states[static_cast<std::size_t>(a)] == ConstraintState::opens) continue;
    const double off = error * length + radii.s[a] + radii.row[a] * primal.acceleration_norm;
    read.second_rates[a] = std::abs(read.second_rates[a]) <= off
                               ? 0
                               : without_rounding(read.second_rates[a], std::abs(s[a]) + length * scale);
  }
  const convex::Multipliers& multipliers = solved.solution.multipliers;
  if (multipliers.ranges && !multipliers.unique) {
    read.ranges = *multipliers.ranges;
    for (const Index row : multipliers.tight) {
      const double length = A.dual_norm(scene.problem.U.row(row));
      convex::Interval& range = read.ranges[static_cast<std::size_t>(row)];
      for (double* end : {&range.low, &range.high})
        if (std::abs(*end) * length <= error) *end = 0;
    }
  }
  if (scene.rates) {
    read.f = scene.rates->f.head(m);
    read.df = scene.rates->df.head(m);
    for (Index a = 0; a < m; ++a) {
      read.f[a] = without_rounding(read.f[a], scene.rates->f_scale[a]);
      read.df[a] = without_rounding(read.df[a], scene.rates->df_scale[a]);
    }
  }
  return read;
}

}  // namespace cli::inline reports
