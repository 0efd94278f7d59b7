#include "cli/report/solve_report.hpp"

#include <cmath>

#include "convex/exact/fraction.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "mechanics/evaluation_error.hpp"
#include "mechanics/near_contact.hpp"

namespace cli::inline reports {

std::optional<double> count_evaluation_error(const Scene& scene, mechanics::GaussSolution& solution) {
  convex::Solution& primal = solution.primal;
  const bool has_answer =
      primal.status == convex::Status::solved || primal.status == convex::Status::inaccurate;
  if (!scene.written || !has_answer || solution.as_written) return std::nullopt;
  const double as_evaluated = primal.error_bound;
  const double error = mechanics::evaluation_error(*scene.written, scene.contacts, scene.added, scene.problem,
                                                   primal, scene.solve.accuracy);
  mechanics::count_evaluation_error(primal, error, scene.solve.accuracy);
  if (scene.added.empty()) {
    mechanics::leave_out_pressing(solution, *scene.written, scene.contacts, scene.problem);
    mechanics::leave_out_opening(solution, scene.problem, scene.solve.accuracy.tolerance);
  }
  return as_evaluated;
}

SolvedScene solved_scene(const Scene& scene, const mechanics::GaussSolution& solution, double seconds) {
  using convex::Index;
  SolvedScene solved{scene, solution, {}, {}, seconds};
  if (!solved.has_answer()) return solved;
  const std::size_t count = scene.constraints.size();
  solved.states.assign(count, ConstraintState::inactive);
  for (Index a : scene.contacts) solved.states[static_cast<std::size_t>(a)] = ConstraintState::opens;
  const auto set_state = [&](const std::vector<Index>& rows, ConstraintState state) {
    for (const Index row : rows)
      if (row < static_cast<Index>(scene.contacts.size()))
        solved.states[static_cast<std::size_t>(scene.contacts[static_cast<std::size_t>(row)])] = state;
  };
  set_state(solution.multipliers.tight, ConstraintState::persists);
  set_state(solution.touching, ConstraintState::touches);
  // Over K, d²f/dt² is the slack of the solution, more accurate than a new evaluation.
  solved.second_rates = scene.system ? scene.system->second_rates(scene.state, solution.primal.q)
                                     : convex::Vector(convex::Vector::Zero(static_cast<Index>(count)));
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    solved.second_rates[scene.contacts[k]] = solution.primal.slack[static_cast<Index>(k)];
  if (scene.written && scene.rates)
    solved.closed_by_tolerance =
        mechanics::closed_by_tolerance(*scene.written, {scene.contacts, *scene.rates});
  return solved;
}

double left_of_contradiction(const SolvedScene& solved) {
  using convex::Fraction;
  const Scene& scene = solved.scene;
  const convex::Vector& w = solved.solution.primal.farkas;
  const convex::IntegerVector& proved = solved.exact != nullptr ? solved.exact->primal.farkas : solved.farkas;
  const bool is_proved = !proved.empty() && proved.size() == static_cast<std::size_t>(w.size());
  std::optional<convex::ExactProblem> written;
  if (!scene.written && !scene.exact.are_doubles) written = scene.exact.make();
  std::vector<Fraction> weights, s;
  std::size_t largest = 0;
  for (convex::Index row = 0; row < w.size(); ++row) {
    if (w[row] == 0) continue;
    const auto a = static_cast<std::size_t>(row);
    weights.push_back(is_proved ? Fraction{proved[a], 1} : convex::fraction(w[row]));
    s.push_back(written ? Fraction{written->s[a], written->row_unit[a]}
                        : convex::fraction(scene.problem.s[row]));
    if (std::abs(w[row]) > std::abs(w[static_cast<convex::Index>(largest)])) largest = a;
  }
  const Fraction sum = dot(convex::exact_vector(weights), convex::exact_vector(s));
  if (!is_proved) return convex::nearest_double(sum);
  // Integers that proved it are printed in a size that doubles hold.
  const Fraction printed = convex::fraction(w[static_cast<convex::Index>(largest)]);
  return convex::nearest_double(sum * printed / Fraction{proved[largest], 1});
}

const char* name(ConstraintState state) {
  switch (state) {
    case ConstraintState::persists:
      return "persists";
    case ConstraintState::touches:
      return "touches";
    case ConstraintState::opens:
      return "opens";
    case ConstraintState::inactive:
      return "inactive";
  }
  return "";
}

bool SolvedScene::is_weighed(std::size_t constraint) const {
  for (const mechanics::AddedRow& row : scene.added)
    for (const auto& [weighed, weight] : row.weights)
      if (weighed == static_cast<convex::Index>(constraint)) return true;
  return false;
}

bool SolvedScene::multipliers_are_unique() const {
  const convex::Multipliers& multipliers = solution.multipliers;
  if (multipliers.unique || scene.added.empty() || !multipliers.ranges) return multipliers.unique;
  for (std::size_t row = 0; row < multipliers.ranges->size(); ++row) {
    const convex::Interval range = (*multipliers.ranges)[row];
    constexpr double rounding = 1e-9;
    const bool is_given =
        row >= scene.contacts.size() || !is_weighed(static_cast<std::size_t>(scene.contacts[row]));
    if (is_given &&
        !(range.high - range.low <= rounding * std::max(std::abs(range.low), std::abs(range.high))))
      return false;
  }
  return true;
}

ConstraintState SolvedScene::state_of_row(convex::Index row) const {
  const auto k = static_cast<std::size_t>(row);
  return k < scene.contacts.size() ? states[static_cast<std::size_t>(scene.contacts[k])]
                                   : ConstraintState::persists;
}

}  // namespace cli::inline reports
