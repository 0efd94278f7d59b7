#include "cli/report/readable_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "cli/report/contact_force.hpp"
#include "convex/nearest_point/reductions/islands.hpp"

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

/// What is rounding, by the island of a coordinate or contact: numbers that nothing couples say nothing of
/// each other.
class Rounding {
 public:
  explicit Rounding(const SolvedScene& solved)
      : solved_(solved),
        islands_(convex::find_islands(solved.scene.problem)),
        scales_(at(islands_.count + 1), -1) {
    const Scene& scene = solved.scene;
    if (!scene.written) return;
    const auto count = static_cast<Index>(scene.contacts.size());
    radius_ =
        mechanics::equations_as_written(*scene.system, scene.state, scene.written->radii, scene.contacts,
                                        solved.solution.primal.q, solved.solution.primal.lambda.head(count))
            .balance.radius;
    if (!radius_.allFinite()) radius_ = Vector();
  }

  static constexpr Index everywhere = -1;  ///< of constraints that are no contacts

  /// The largest of ||q''||_A and ||z||_(A⁻¹) there; 0 beside one that is beyond doubles.
  double scale(Index island) {
    double& known = scales_[at(island + 1)];
    if (known >= 0) return known;
    const convex::NearestPointProblem& problem = solved_.scene.problem;
    known = std::max(problem.A.norm(within(island, solved_.solution.primal.q)),
                     problem.A.dual_norm(within(island, problem.z)));
    return known = std::isfinite(known) ? known : 0;
  }
  /// Of a system A and z are rounded, by what its text tells of its equations; numbers of a projection are
  /// those that were read.
  double error(Index island) {
    const double size = scale(island), answer = std::min(missing(), coarsest * size);
    if (!solved_.scene.system) return answer;
    if (radius_.size() == 0) return std::max(answer, rounding * size);
    return std::max(answer, solved_.scene.problem.A.dual_norm(within(island, radius_)));
  }
  /// Of the error bound what is not the rounding of q'' to doubles, which leaves every entry its digits.
  double missing() const {
    const convex::Solution& primal = solved_.solution.primal;
    return std::max(0.0, primal.error_bound - primal.rounding);
  }
  Index of_coordinate(Index i) const { return islands_.of_coordinate[at(i)]; }
  Index of_row(Index a) const { return islands_.of_row[at(a)]; }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  Vector within(Index island, Vector x) const {
    for (Index i = 0; i < x.size(); ++i)
      if (island != everywhere && islands_.of_coordinate[at(i)] != island) x[i] = 0;
    return x;
  }

  const SolvedScene& solved_;
  convex::Islands islands_;
  std::vector<double> scales_;
  Vector radius_;  ///< of z + Σ lambda_a u_a - A q'' as written, by coordinate
};

}  // namespace

double without_rounding(double x, double scale) { return std::abs(x) <= rounding * scale ? 0 : x; }

Vector without_rounding(const SolvedScene& solved, Vector acceleration) {
  const convex::Metric& A = solved.scene.problem.A;
  Rounding known(solved);
  std::map<Index, double> largest;
  for (Index i = 0; i < acceleration.size(); ++i) {
    double& there = largest[known.of_coordinate(i)];
    there = std::max(there, std::abs(acceleration[i]));
  }
  for (Index i = 0; i < acceleration.size(); ++i) {
    if (acceleration[i] == 0) continue;
    const Index island = known.of_coordinate(i);
    // Where all are that small, it is the error bound alone that tells.
    const double error = known.error(island), off = std::abs(acceleration[i]) > 1e-6 * largest[island]
                                                        ? std::min(error, known.missing())
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
  Rounding known(solved);
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
    if (std::abs(read.reaction[i]) <= known.error(known.of_coordinate(i)) * std::sqrt(A.diagonal()[i]))
      read.reaction[i] = 0;
  Vector s;
  const convex::ConstraintRows rows = rows_of(scene, m, s);
  convex::DataRadii radii{Vector::Zero(m), Vector::Zero(m)};
  if (scene.written) {
    std::vector<Index> first(static_cast<std::size_t>(m));
    std::iota(first.begin(), first.end(), Index{0});
    radii = mechanics::row_radii(*scene.system, scene.state, scene.written->radii, first, A);
  }
  std::vector<Index> island(static_cast<std::size_t>(scene.constraints.size()), Rounding::everywhere);
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    island[static_cast<std::size_t>(scene.contacts[k])] = known.of_row(static_cast<Index>(k));
  for (Index a = 0; a < m; ++a) {
    const Vector u = rows.row(a);
    const double length = A.dual_norm(u), error = known.error(island[static_cast<std::size_t>(a)]);
    if (std::abs(read.lambda[a]) * length <= error) read.lambda[a] = 0;
    if (read.lambda[a] != 0)
      if (const auto factor = force_per_multiplier(scene, a))
        read.forces[static_cast<std::size_t>(a)] = std::abs(read.lambda[a]) * *factor;
    // What opens was told from rounding before.
    if (solved.states[static_cast<std::size_t>(a)] == ConstraintState::opens) continue;
    const double off = error * length + radii.s[a] + radii.row[a] * primal.acceleration_norm,
                 terms = scene.system ? length * known.scale(island[static_cast<std::size_t>(a)])
                                      : u.cwiseAbs().dot(primal.q.cwiseAbs());
    read.second_rates[a] = std::abs(read.second_rates[a]) <= off
                               ? 0
                               : without_rounding(read.second_rates[a], std::abs(s[a]) + terms);
  }
  const convex::Multipliers& multipliers = solved.solution.multipliers;
  if (multipliers.ranges && !multipliers.unique) {
    read.ranges = *multipliers.ranges;
    for (const Index row : multipliers.tight) {
      const double length = A.dual_norm(scene.problem.U.row(row)), error = known.error(known.of_row(row));
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
