#include "convex/nearest_point/pivoting/gram_solution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/nearest_point/optimality/gathered_residuals.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex::inline pivoting {
namespace {

/// ||q||_A is that of w, which is what is left of z and the pushes of the rows: where these cancel, of q
/// itself.
void measure_again_where_it_cancels(const NearestPointProblem& problem, double scale, GramPoint& p) {
  constexpr double much = 0x1p-20;
  double most = scale;
  for (Index k = 0; k < p.size; ++k) most = std::max(most, std::abs(p.lambda[k]) * p.length[k]);
  if (p.acceleration_norm > much * most) return;
  const bool is_zero = std::all_of(p.q, p.q + p.n, [](double x) { return x == 0; });
  p.acceleration_norm = is_zero ? 0 : problem.A.norm(Eigen::Map<const Vector>(p.q, p.n));
}

}  // namespace

void set_held_slacks_apart(GramPoint& p) {
  for (Index k = 0; k < p.size; ++k)
    p.held_slack[k] = std::exchange(p.slack[p.rows[k]], std::numeric_limits<double>::infinity());
}

Index close_rows(GramPoint& p, const NearestPointProblem& problem, double absolute, double by_length,
                 Index most) {
  const double* const s = problem.s.data();
  return small_kernels().close_rows(p.all, p.slack, s, s + p.all, p.row_scale, absolute, by_length, most,
                                    p.close);
}

void write(const NearestPointProblem& problem, GramPoint& p, const PointError& known,
           const Accuracy& accuracy, Solution& solution) {
  measure_again_where_it_cancels(problem, known.scale, p);
  // `convex::residuals`, to which only the working set and degenerate rows matter; measured in doubles.
  double most = 0;
  for (Index k = 0; k < p.size; ++k) most = std::max(most, std::abs(p.lambda[k]));
  GatheredResiduals held(p.stationarity, p.acceleration_norm, known.scale, most);
  for (Index k = 0; k < p.size; ++k)
    held.add(problem.s[p.rows[k]], p.length[k], p.lambda[k], p.held_slack[k], !(p.pull[k] > 0));
  solution.residuals = held.all();
  solution.residuals.feasibility = std::max(solution.residuals.feasibility, known.violation);
  solution.method = "active-set";
  solution.undecided = known.undecided;
  solution.model.islands.clear();
  solution.steps = p.steps;
  solution.farkas.resize(0);
  solution.q = Eigen::Map<const Vector>(p.q, p.n);
  solution.lambda.setZero(p.all);
  solution.slack = Eigen::Map<const Vector>(p.slack, p.all);
  for (Index k = 0; k < p.size; ++k) {
    solution.lambda[p.rows[k]] = p.lambda[k];
    solution.slack[p.rows[k]] = 0;
  }
  solution.basis.assign(p.rows, p.rows + p.size);
  solution.acceleration_norm = p.acceleration_norm;
  solution.force_norm = p.z_norm;
  solution.rounding = known.rounding;
  solution.error_bound = known.bound;
  solution.status = solution.is_within(accuracy) ? Status::solved : Status::inaccurate;
}

}  // namespace convex::inline pivoting
