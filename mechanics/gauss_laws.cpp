#include "mechanics/gauss_laws.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/laws/worst_check.hpp"
#include "convex/linear_algebra/singular_values.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "mechanics/farkas_laws.hpp"
#include "mechanics/gauss_function.hpp"
#include "mechanics/reaction_law.hpp"
#include "mechanics/units.hpp"

namespace mechanics {
namespace {

using convex::check_that;
using convex::LawReport;
using convex::Matrix;
using convex::unit_roundoff;
using convex::WorstCheck;

/// Roundings of a sum, relative to the sum of its absolute terms; a sum of n terms has about sqrt(n) times as
/// much (Higham and Mary 2019).
constexpr double roundings = 16 * unit_roundoff;

/// The dual is not asked for beyond so many numbers in the whitened rows: it takes dense algebra on them.
constexpr Index most_dual_numbers = 1'000'000;

/// A bound that is more than this part of the sizes judges nothing.
constexpr double widest_bound = 1e-3;

/// A solution with the scales that its laws are judged by.
struct Judged {
  const convex::NearestPointProblem& problem;
  const GaussSolution& solution;
  Vector slack;   ///< Uq'' - s, rounded once: m
  Vector length;  ///< ||u_a||_(A⁻¹): m, 0 where no law needs it
  Vector row;     ///< what the error bound, rounding and radii allow u_a·q'' - s_a: m
  double size;    ///< ||q''||_A + ||z||_(A⁻¹)
  double data;    ///< what the rounding of A, z and U to doubles may leave of the balance, in ||.||_(A⁻¹)
  std::vector<bool> two_sided;
  const Vector& q() const { return solution.primal.q; }
  const Vector& lambda() const { return solution.multipliers.least_norm; }
  bool is_two_sided(Index a) const { return two_sided[static_cast<std::size_t>(a)]; }
  double error() const { return solution.primal.error_bound; }
  double steps() const { return static_cast<double>(problem.dimension() + problem.rows()); }
};

/// Rows are those of the mechanism within their radii. Those that depend on each other count as consistent:
/// what the radii of one of them leave open shifts all.
void allow_radii(Judged& j, const convex::DataRadii& radii) {
  const Vector way = radii.s + radii.row * j.problem.A.norm(j.q());
  double farthest = 0;
  if (!j.solution.multipliers.unique)
    for (const Index a : j.solution.multipliers.tight)
      if (j.length[a] > 0) farthest = std::max(farthest, way[a] / j.length[a]);
  j.row += way + farthest * j.length;
}

/// |A||q|.
Vector absolute_product(const convex::Metric& A, const Vector& q) {
  switch (A.kind()) {
    case convex::MetricKind::dense:
      return A.dense_gram().cwiseAbs() * q.cwiseAbs();
    case convex::MetricKind::sparse:
      return A.sparse_gram().cwiseAbs() * q.cwiseAbs();
    default:
      return A.diagonal().cwiseProduct(q).cwiseAbs();
  }
}

/// An answer in fractions is that of the numbers as written. What their rounding to doubles may leave of its
/// balance: Σ_i v_i ||e_i||_(A⁻¹), v = u (|A||q''| + |z| + |Uᵀ||lambda|) by coordinate.
double rounding_of_data(const Judged& j) {
  Vector sizes = absolute_product(j.problem.A, j.q()) + j.problem.z.cwiseAbs();
  for (Index a = 0; a < j.problem.rows(); ++a)
    if (j.lambda()[a] != 0)
      j.problem.U.for_each_entry(a, [&](Index i, double u) { sizes[i] += std::abs(j.lambda()[a] * u); });
  double sum = 0;
  for (Index i = 0; i < sizes.size(); ++i)
    if (sizes[i] > 0) sum += unit_roundoff * sizes[i] * j.problem.A.dual_norm(Vector::Unit(sizes.size(), i));
  return sum;
}

Judged judged(const convex::NearestPointProblem& problem, const GaussSolution& solution) {
  const Index m = problem.rows();
  Judged j{problem, solution, Vector(m), {}, Vector(m), 0, 0, std::vector<bool>(static_cast<std::size_t>(m))};
  for (Index a : problem.two_sided) j.two_sided[static_cast<std::size_t>(a)] = true;
  const convex::DoubleDoubleVector point(j.q());
  std::vector<Index> matter;
  for (Index a = 0; a < m; ++a) {
    j.slack[a] = convex::slack(problem, a, point).value();
    if (j.slack[a] <= 0 || j.is_two_sided(a) || j.lambda()[a] != 0) matter.push_back(a);
  }
  j.length = convex::dual_lengths(problem, matter);
  const Vector magnitude = j.q().cwiseAbs();
  for (Index a = 0; a < m; ++a)
    j.row[a] =
        j.length[a] * j.error() + roundings * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude));
  if (problem.radii) allow_radii(j, *problem.radii);
  j.size = problem.A.norm(j.q()) + problem.A.dual_norm(problem.z);
  if (solution.as_written) j.data = rounding_of_data(j);
  return j;
}

/// 1 / the smallest singular value of the rows that the answer rests on, whitened and of length 1: what their
/// near-dependence makes of an error in s.
double condition_of_basis(const Judged& j) {
  const std::vector<Index>& basis = j.solution.primal.basis;
  if (basis.empty()) return 1;
  Matrix V(j.problem.dimension(), static_cast<Index>(basis.size()));
  for (std::size_t k = 0; k < basis.size(); ++k) j.problem.U.copy_row(basis[k], V.col(static_cast<Index>(k)));
  j.problem.A.whiten_in_place(V);
  V.colwise().normalize();
  const double smallest = convex::linear_algebra::singular_values(V).minCoeff();
  return 1 / std::max(smallest, unit_roundoff);
}

void feasibility_laws(const Judged& j, LawReport& report) {
  WorstCheck kept("u_a.q'' >= s_a on the contacts: x is in C"), signs("lambda_a >= 0"),
      complementary("lambda_a (u_a.q'' - s_a) = 0");
  const double largest = j.lambda().size() > 0 ? j.lambda().cwiseAbs().maxCoeff() : 0;
  for (Index a = 0; a < j.problem.rows(); ++a) {
    const double violation = j.is_two_sided(a) ? std::abs(j.slack[a]) : std::max(0.0, -j.slack[a]);
    if (violation > 0 || j.length[a] > 0) kept.take(violation, j.row[a]);
    if (!j.is_two_sided(a)) signs.take(std::max(0.0, -j.lambda()[a]), roundings * largest);
    if (std::abs(j.lambda()[a]) > 0) {
      // A multiplier is no nearer to its own than rounding in the forces leaves it.
      const double near = j.length[a] > 0 ? roundings * j.size / j.length[a] : 0;
      complementary.take(std::abs(j.lambda()[a] * j.slack[a]),
                         std::abs(j.lambda()[a]) * j.row[a] + near * std::abs(j.slack[a]));
    }
  }
  report.checks.push_back(kept.check());
  report.checks.push_back(signs.check());
  report.checks.push_back(complementary.check());
}

/// What solving with A as it was read and forming its products may leave, in the norm of forces.
double force_rounding(const Judged& j) {
  double loads = 0;
  for (Index a = 0; a < j.problem.rows(); ++a) loads += std::abs(j.lambda()[a]) * j.length[a];
  return j.data + roundings * std::sqrt(j.steps()) * j.problem.A.factor_condition() * (j.size + loads);
}

void balance_law(const Judged& j, LawReport& report) {
  std::vector<Index> rows;
  for (Index a = 0; a < j.problem.rows(); ++a)
    if (std::abs(j.lambda()[a]) > 0) rows.push_back(a);
  convex::DoubleDoubleVector lambda(static_cast<Index>(rows.size()));
  double loads = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    lambda.hi[static_cast<Index>(k)] = j.lambda()[rows[k]];
    loads += std::abs(j.lambda()[rows[k]]) * j.length[rows[k]];
  }
  const Vector rest =
      convex::stationarity_residual(j.problem, convex::DoubleDoubleVector(j.q()), rows, lambda);
  // Parts of dependent rows in each other below 64 roundings are left out of the least norm.
  constexpr double of_dependences = 2 * 64 * unit_roundoff;
  const double of_loads =
      roundings + (j.solution.multipliers.unique ? 0 : of_dependences * std::sqrt(j.steps()));
  report.checks.push_back(
      check_that("A q'' = z + sum of lambda_a u_a", j.problem.A.dual_norm(rest),
                 j.error() + j.solution.taken_for_zero + j.data + roundings * j.size + of_loads * loads));
}

/// The reaction from the dual alone, with what made it.
struct DualRoute {
  std::optional<ReactionFromDual> found;
  const char* how;
};

DualRoute dual_route(const Judged& j) {
  if (j.solution.from_dual) return {j.solution.from_dual, "section 5's cone"};
  const Index numbers = j.problem.dimension() * j.problem.rows();
  if (numbers <= most_dual_numbers && j.solution.hypothesis.two_sided.consistent)
    if (auto found = reaction_from_dual(j.problem, j.solution.hypothesis.two_sided, j.solution.primal))
      return {std::move(found), "section 5's cone"};
  if (numbers <= most_dual_numbers)
    return {reaction_by_least_distance(j.problem, j.solution.primal), "least distance"};
  return {std::nullopt, ""};
}

/// What the error bound and rounding may leave between the two routes. The dual's cone stands at x_0: what
/// x_0 misses of the contacts moves y. Its factor F of A, rounded, is that of another metric, apart by
/// roundings times cond(F)² (Higham 2002, theorem 10.3).
double apart_by_rounding(const Judged& j, const ReactionFromDual& dual) {
  const double size = j.size + dual.apex_norm, of_factor = j.problem.A.factor_condition();
  const double of_data = j.data > 0 ? j.data * size / j.size : 0;
  return j.error() + force_rounding(j) +
         condition_of_basis(j) / dual.thinnest * std::sqrt(j.steps()) *
             (dual.apex_missed + of_data + roundings * of_factor * (1 + of_factor) * size);
}

void decomposition_law(const Judged& j, const DualRoute& dual, LawReport& report) {
  if (!dual.found) {
    report.no_evidence.emplace_back(
        "z = x + y: the dual route did not reach y, and y from the primal would prove nothing");
    return;
  }
  const double bound = apart_by_rounding(j, *dual.found);
  if (dual.found->thinnest < 1 && !(bound <= widest_bound * j.size)) {
    report.no_evidence.emplace_back(
        "z = x + y: the cone of the contacts is so thin that rounding leaves the dual's y open");
    return;
  }
  report.checks.push_back(
      check_that(std::string("z = x + y, x = A q'' from the primal, y = -R from the dual by ") + dual.how,
                 j.problem.A.dual_norm(dual.found->reaction - gauss_gradient(j.problem, j.q())), bound));
}

void nearest_reaction_law(const Judged& j, LawReport& report) {
  const TwoSided& two_sided = j.solution.hypothesis.two_sided;
  if (!two_sided.consistent) return;
  // With R_0 = A q_0 - z, a force R + t u_a is farther from R_0 than R is when t (R_0 - R|u_a) <= t² |u_a|²/2
  // for all small t: u_a·(q_0 - q'') <= 0, and = 0 where R may lose some of u_a.
  WorstCheck nearest("no other force of the contacts is as near to the two-sided reaction");
  const Vector apart = j.problem.U.times(two_sided.acceleration - j.q());
  const Vector magnitude = two_sided.acceleration.cwiseAbs() + j.q().cwiseAbs();
  for (Index a = 0; a < j.problem.rows(); ++a) {
    const bool both_ways = j.is_two_sided(a) || j.lambda()[a] > 0;
    if (both_ways || apart[a] > 0) {
      const double length = j.length[a] > 0 ? j.length[a] : j.problem.A.dual_norm(j.problem.U.row(a));
      const double bound = 2 * (j.row[a] + length * j.error()) +
                           roundings * std::sqrt(j.steps()) * j.problem.A.factor_condition() *
                               (j.problem.U.absolute_dot(a, magnitude) +
                                length * (j.size + j.problem.A.norm(two_sided.acceleration)));
      nearest.take(both_ways ? std::abs(apart[a]) : apart[a], bound);
    }
  }
  report.checks.push_back(nearest.check());
}

void conjugacy_law(const Judged& j, LawReport& report) {
  const double power = j.solution.reaction.dot(j.q()), support = j.lambda().dot(j.problem.s);
  const double terms = j.solution.reaction.cwiseAbs().dot(j.q().cwiseAbs()) +
                       j.lambda().cwiseAbs().dot(j.problem.s.cwiseAbs() + j.row);
  const double bound = roundings * std::sqrt(j.steps()) * terms + j.lambda().cwiseAbs().dot(j.row) +
                       (j.error() + force_rounding(j)) * j.size;
  report.checks.push_back(
      check_that("conjugacy f(x) + g(y) = (x|y): R.q'' = lambda.s", std::abs(power - support), bound));
}

/// Other accelerations that the contacts allow: those that other forces would have made.
std::vector<Vector> rivals(const Judged& j, const GaussOptions& options) {
  std::vector<Vector> found;
  if (j.solution.hypothesis.two_sided.consistent)
    found.push_back(j.solution.hypothesis.two_sided.acceleration);
  std::mt19937 generator(1966);
  std::normal_distribution<double> normal;
  convex::NearestPointProblem other = j.problem;
  for (int k = 0; k < 3; ++k) {
    Vector push(j.q().size());
    for (double& entry : push) entry = normal(generator);
    const double size = j.problem.A.dual_norm(push);
    other.z = j.problem.z + push * ((j.size > 0 ? j.size : 1) / size);
    const convex::Solution moved = options.method->solve(other, options.accuracy);
    if (moved.status == convex::Status::solved) found.push_back(moved.q);
  }
  return found;
}

/// Σ |lambda_a| of what the radii of the rows allow u_a·x.
double rows_at(const Judged& j, const Vector& x) {
  if (!j.problem.radii) return 0;
  return j.lambda().cwiseAbs().dot(j.problem.radii->s + j.problem.radii->row * j.problem.A.norm(x));
}

void uniqueness_law(const Judged& j, const GaussOptions& options, LawReport& report) {
  WorstCheck least("no other acceleration that the contacts allow has as small a G");
  const Vector gradient = gauss_gradient(j.problem, j.q());
  const double rounding = force_rounding(j);
  for (const Vector& rival : rivals(j, options))
    for (double step : {1.0, 1e-3}) {
      const Vector d = step * (rival - j.q());
      // G(q'' + d) - G(q'') - ½||d||² = (A q'' - z)·d.
      const double size = j.problem.A.norm(rival) + j.size;
      const double bound = (j.error() + rounding) * (j.problem.A.norm(d) + j.size) +
                           rows_at(j, step * rival) +
                           roundings * std::sqrt(j.steps()) * j.problem.A.factor_condition() * size * j.size;
      least.take(std::max(0.0, -gradient.dot(d)), bound);
    }
  report.checks.push_back(least.check());
}

LawReport laws_as_it_stands(const convex::NearestPointProblem& problem, const GaussSolution& solution,
                            const GaussOptions& options) {
  LawReport report;
  if (solution.primal.status == convex::Status::infeasible) {
    convex::NearestPointProblem judged_rows = problem;
    if (solution.as_written) judged_rows.radii.reset();  // decided in fractions on the numbers as written
    return farkas_laws(judged_rows, solution.primal.farkas);
  }
  if (solution.multipliers.least_norm.size() != problem.rows()) return report;
  const Judged j = judged(problem, solution);
  feasibility_laws(j, report);
  balance_law(j, report);
  report.checks.push_back(reaction_law(problem, solution));
  decomposition_law(j, dual_route(j), report);
  nearest_reaction_law(j, report);
  conjugacy_law(j, report);
  uniqueness_law(j, options, report);
  return report;
}

LawReport laws_in_units(const convex::NearestPointProblem& problem, const GaussSolution& solution,
                        const GaussOptions& options) {
  const Units units = fit_units(problem);
  if (units.ordinary() || solution.primal.status == convex::Status::infeasible)
    return laws_as_it_stands(problem, solution, options);
  GaussSolution given = solution;
  restore_units(given, units.inverse(), options.accuracy.tolerance);
  return laws_as_it_stands(in_units(problem, units), given, options);
}

}  // namespace

double apart_by_rounding(const convex::NearestPointProblem& problem, const GaussSolution& solution) {
  return solution.from_dual ? apart_by_rounding(judged(problem, solution), *solution.from_dual) : 0;
}

LawReport gauss_laws(const convex::NearestPointProblem& problem, const GaussSolution& solution,
                     const GaussOptions& options) {
  if (solution.primal.status != convex::Status::infeasible && !std::isfinite(solution.primal.error_bound)) {
    LawReport nothing;
    nothing.no_evidence.emplace_back("of this acceleration: nothing is known of its error");
    return nothing;
  }
  // Squares of extreme numbers are not doubles: the laws are tried on the same answer where they are.
  if (const Vector rows = row_units(problem); !rows.isOnes(0))
    return laws_in_units(in_row_units(problem, rows), in_row_units(solution, rows), options);
  return laws_in_units(problem, solution, options);
}

}  // namespace mechanics
