#include "mechanics/singular/singular_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/singular/suspect_rows.hpp"

namespace mechanics::inline singular_states {
namespace {

using expression::Rounded;

/// Operations, and numbers of its gradients, that looking at a group may cost: seconds.
constexpr double most_operations = 2e7, most_numbers = 1e6;

/// The two-sided constraints that hang together with suspect ones by the coordinates that their expressions
/// name: gradients may vanish at the state that do not elsewhere.
std::vector<std::vector<Index>> groups_of(const LagrangianSystem& system, const std::vector<Index>& two_sided,
                                          const std::vector<Index>& suspects) {
  const auto coordinates = expression::coordinates_of(system.model().contacts, two_sided);
  std::vector<std::vector<std::size_t>> users(system.coordinates().size());
  for (std::size_t k = 0; k < two_sided.size(); ++k)
    for (const Index i : coordinates[k]) users[static_cast<std::size_t>(i)].push_back(k);
  std::vector<bool> seen(two_sided.size()), seen_coordinate(users.size());
  std::vector<std::vector<Index>> found;
  for (std::size_t first = 0; first < two_sided.size(); ++first) {
    if (seen[first] || !std::binary_search(suspects.begin(), suspects.end(), two_sided[first])) continue;
    std::vector<std::size_t> open{first};
    seen[first] = true;
    std::vector<Index>& group = found.emplace_back();
    while (!open.empty()) {
      const std::size_t k = open.back();
      open.pop_back();
      group.push_back(two_sided[k]);
      for (const Index i : coordinates[k]) {
        if (seen_coordinate[static_cast<std::size_t>(i)]) continue;
        seen_coordinate[static_cast<std::size_t>(i)] = true;
        for (const std::size_t other : users[static_cast<std::size_t>(i)])
          if (!seen[other]) {
            seen[other] = true;
            open.push_back(other);
          }
      }
    }
    std::sort(group.begin(), group.end());
  }
  return found;
}

/// The rows with some of them replaced, or more of them.
convex::ConstraintRows with_rows(const convex::ConstraintRows& U, const std::map<Index, Vector>& rows) {
  const Index count = std::max(U.count(), rows.empty() ? 0 : rows.rbegin()->first + 1);
  if (!U.is_sparse()) {
    convex::RowMatrix all(count, U.dimension());
    all.topRows(U.count()) = U.dense();
    for (const auto& [a, row] : rows) all.row(a) = row.transpose();
    return convex::ConstraintRows(std::move(all));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Index a = 0; a < U.count(); ++a)
    if (rows.count(a) == 0)
      for (convex::SparseRows::InnerIterator it(U.sparse(), a); it; ++it)
        entries.emplace_back(a, it.col(), it.value());
  for (const auto& [a, row] : rows)
    for (Index i = 0; i < row.size(); ++i)
      if (row[i] != 0) entries.emplace_back(a, i, row[i]);
  convex::SparseRows all(count, U.dimension());
  all.setFromTriplets(entries.begin(), entries.end());
  return convex::ConstraintRows(std::move(all));
}

std::string listed(const LagrangianSystem& system, const std::vector<Index>& constraints) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, constraints.size()); ++k)
    text += (k > 0 ? ", " : "") + system.constraints()[static_cast<std::size_t>(constraints[k])].name;
  if (constraints.size() > most) text += " and " + std::to_string(constraints.size() - most) + " more";
  return text;
}

}  // namespace

SingularState::SingularState(const LagrangianSystem& system, const State& state, const StateRadii& radii,
                             const GaussProblem& gauss)
    : system_(system),
      state_(state),
      radii_(radii),
      unit_(gauss.problem.A.diagonal().cwiseSqrt().cwiseInverse()),
      row_of_(system.constraints().size(), -1) {
  if (gauss.problem.two_sided.empty()) return;
  const auto constraint_of = [&](Index row) { return gauss.contacts.present[static_cast<std::size_t>(row)]; };
  for (std::size_t k = 0; k < gauss.contacts.present.size(); ++k)
    row_of_[static_cast<std::size_t>(gauss.contacts.present[k])] = static_cast<Index>(k);
  for (const Index row : gauss.problem.two_sided) two_sided_.push_back(constraint_of(row));
  const SuspectRows suspects = suspect_rows(gauss, unit_);
  for (const Index row : suspects.unseen) unseen_.push_back(constraint_of(row));
  std::vector<Index> suspect;
  for (const Index row : suspects.rows) suspect.push_back(constraint_of(row));
  look_at(suspect);
}

void SingularState::look_at(const std::vector<Index>& suspects) {
  if (suspects.empty()) return;
  const auto can_be_seen = [&](const std::vector<Index>& constraints) {
    const expression::ConstraintSeries series(system_.model(), constraints);
    const auto columns = static_cast<double>(series.coordinates().size());
    return columns * static_cast<double>(constraints.size()) <= most_numbers &&
           columns * static_cast<double>(series.work()) <= most_operations;
  };
  for (std::vector<Index>& constraints : groups_of(system_, two_sided_, suspects)) {
    // Of a group too large, what depends on each other: enough to test an answer.
    if (!can_be_seen(constraints)) {
      std::vector<Index> some;
      std::set_intersection(constraints.begin(), constraints.end(), suspects.begin(), suspects.end(),
                            std::back_inserter(some));
      if (!can_be_seen(some)) {
        too_many_.insert(too_many_.end(), some.begin(), some.end());
        continue;
      }
      constraints = std::move(some);
    }
    SingularGroup group(system_, state_, radii_, unit_, std::move(constraints));
    if (group.is_singular() || group.is_undecided()) groups_.push_back(std::move(group));
  }
}

/// Of groups too large for a first look, those rows are looked at on which multipliers depend.
void SingularState::look_at_rest(const GaussSolution& answer) {
  std::vector<Index> all;
  std::swap(all, unseen_);
  if (answer.multipliers.unique) return;
  if (!answer.multipliers.null_space) {
    too_many_ = std::move(all);
    return;
  }
  std::set<Index> rows;
  for (const convex::NullVector& weights : *answer.multipliers.null_space)
    for (const auto& [row, weight] : weights) rows.insert(row);
  std::vector<Index> suspects;
  for (const Index a : all)
    if (rows.count(row_of_[static_cast<std::size_t>(a)]) > 0) suspects.push_back(a);
  std::sort(suspects.begin(), suspects.end());
  look_at(suspects);
}

bool SingularState::settle(convex::NearestPointProblem& problem) const {
  bool settled_some = false;
  for (const SingularGroup& group : groups_)
    for (const SingularGroup::Settled& settled : group.settled()) {
      Vector gradient = Vector::Zero(problem.dimension());
      double bound = 0;
      for (const auto& [constraint, coefficient] : settled.combination) {
        const Index other = row_of_[static_cast<std::size_t>(constraint)];
        gradient += coefficient * problem.U.row(other);
        bound += coefficient * problem.s[other];
      }
      const Index row = row_of_[static_cast<std::size_t>(settled.constraint)];
      if (!settled.is_consistent) bound = problem.s[row];
      if (problem.U.row(row) == gradient && problem.s[row] == bound) continue;
      problem.s[row] = bound;
      problem.U = with_rows(problem.U, {{row, std::move(gradient)}});
      settled_some = true;
    }
  return settled_some;
}

std::optional<convex::NearestPointProblem> SingularState::without_repeated(
    const convex::NearestPointProblem& problem) {
  std::map<Index, Vector> rows;
  convex::NearestPointProblem found = problem;
  for (const SingularGroup& group : groups_)
    for (const SingularGroup::Repeated& repeated : group.repeated()) {
      const Index row = row_of_[static_cast<std::size_t>(repeated.main)];
      rows[row] = Vector::Zero(problem.dimension());
      found.s[row] = 0;
    }
  if (left_out_ || rows.empty()) return std::nullopt;
  left_out_ = true;
  found.U = with_rows(problem.U, rows);
  return found;
}

convex::NearestPointProblem SingularState::without_one_sided(
    const convex::NearestPointProblem& problem) const {
  convex::NearestPointProblem found = problem;
  std::map<Index, Vector> rows;
  for (Index a = 0; a < problem.rows(); ++a) {
    if (problem.is_two_sided(a)) continue;
    rows[a] = Vector::Zero(problem.dimension());
    found.s[a] = 0;
    if (found.radii) found.radii->row[a] = found.radii->s[a] = 0;
  }
  found.U = with_rows(problem.U, rows);
  return found;
}

std::vector<AddedRow> SingularState::missing(const convex::NearestPointProblem& problem,
                                             const GaussSolution& solution) {
  const convex::Solution& answer = solution.primal;
  std::vector<AddedRow> found;
  if (!unseen_.empty()) look_at_rest(solution);
  if (groups_.empty() || answer.q.size() != problem.dimension()) return found;
  const Index n = problem.dimension();
  std::vector<Rounded> q2(static_cast<std::size_t>(n));
  std::set<Index> needed;
  for (const SingularGroup& group : groups_) needed.insert(group.columns().begin(), group.columns().end());
  for (const Index i : needed) {
    // |e_i| <= sqrt((A⁻¹)_ii) ||e||_A.
    const double reach = std::sqrt(problem.A.solve(Vector::Unit(n, i))[i]);
    q2[static_cast<std::size_t>(i)] = {answer.q[i],
                                       reach * answer.error_bound + 0x1p-53 * std::abs(answer.q[i])};
  }
  for (SingularGroup& group : groups_)
    for (AddedRow& row : group.missing(q2)) found.push_back(std::move(row));
  return found;
}

std::vector<Warning> SingularState::warnings(const std::vector<AddedRow>& added, bool infeasible) const {
  std::vector<Warning> found;
  const expression::LagrangianModel& model = system_.model();
  const auto say = [&](const std::vector<Index>& constraints, const std::string& what) {
    found.push_back({Warning::Kind::singular, constraints, listed(system_, constraints) + ": " + what});
  };
  for (const Index a : model.bases)
    say({a}, "its gradient vanishes wherever it holds; it is read as " +
                 written(model.tape, model.f[static_cast<std::size_t>(a)], model.coordinates) +
                 " = 0, of which f, df/dt, d²f/dt² and the multiplier are given");
  std::set<Index> held;
  for (const AddedRow& row : added) {
    if (row.is_linear_form) {
      if (held.insert(row.main).second)
        say({row.main},
            "its gradient vanishes wherever it holds near this state, and it is held to the linear equations "
            "that say the same; its own multiplier is not given");
      continue;
    }
    std::vector<Index> constraints;
    for (const auto& [constraint, weight] : row.weights) constraints.push_back(constraint);
    say(constraints,
        (constraints.size() == 1 ? "its gradient vanishes at this state only"
                                 : "their gradients depend on each other at this state only") +
            std::string(", and the acceleration that second derivatives give contradicts higher ones; their "
                        "equation was added. Multipliers of these constraints grow without bound near such a "
                        "state and are not given"));
  }
  for (const SingularGroup& group : groups_)
    for (const SingularGroup::Settled& settled : group.settled())
      if (settled.by_state) {
        std::vector<Index> constraints;
        for (const auto& [constraint, coefficient] : settled.combination) constraints.push_back(constraint);
        constraints.push_back(settled.constraint);
        say(constraints,
            "their gradients depend on each other but for what the state misses of f = 0 and df/dt = 0, and "
            "count as dependent; give the state with more digits");
      }
  if (infeasible)
    for (const SingularGroup& group : groups_)
      for (const SingularGroup::Repeated& contradicted : group.contradicted())
        say(contradicted.constraints,
            (contradicted.constraints.size() == 1 ? "its gradient vanishes at this state"
                                                  : "their gradients depend on each other at this state") +
                std::string(
                    ", and with this velocity d²f/dt² is not 0 whatever the acceleration: the velocity "
                    "is on no branch of the motions through this position; give it another one"));
  if (left_out_ && !infeasible)
    for (const SingularGroup& group : groups_)
      for (const SingularGroup::Repeated& repeated : group.repeated())
        if (repeated.constraints.size() > 1)
          say(repeated.constraints,
              "their gradients depend on each other but for rounding, which contradicts itself; " +
                  listed(system_, {repeated.main}) +
                  " was left out, and the multipliers are those without it");
  for (const SingularGroup& group : groups_)
    if (group.is_undecided())
      say(group.constraints(),
          "their gradients may depend on each other at this state only, and what would tell, derivatives or "
          "f "
          "nearby, is not finite or of too high an order; compare another state");
  if (!too_many_.empty())
    say(too_many_,
        "their gradients depend on those of other constraints, too many to see whether they do so at this "
        "state only; compare a state nearby");
  return found;
}

convex::NearestPointProblem SingularState::extended(const convex::NearestPointProblem& problem,
                                                    const std::vector<AddedRow>& added) const {
  convex::NearestPointProblem found = problem;
  Index last = problem.rows();
  const Index count = last + static_cast<Index>(added.size());
  found.s.conservativeResize(count);
  if (found.radii) {
    found.radii->row.conservativeResize(count);
    found.radii->s.conservativeResize(count);
  }
  const auto set_radii = [&](Index row, double of_row, double of_bound) {
    if (!found.radii) return;
    found.radii->row[row] = of_row;
    found.radii->s[row] = of_bound;
  };
  std::map<Index, Vector> rows;
  for (const AddedRow& row : added) {
    const Index left_out = row_of_[static_cast<std::size_t>(row.main)];
    rows[left_out] = Vector::Zero(problem.dimension());
    found.s[left_out] = 0;
    set_radii(left_out, 0, 0);
    rows[last] = row.row;
    found.s[last] = row.rhs;
    set_radii(last, row.row_radius, row.rhs_radius);
    found.two_sided.push_back(last++);
  }
  found.U = with_rows(problem.U, rows);
  return found;
}

}  // namespace mechanics::inline singular_states
