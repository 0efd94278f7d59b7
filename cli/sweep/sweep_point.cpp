#include "cli/sweep/sweep_point.hpp"

#include <cmath>
#include <limits>

#include "cli/assembled_state.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/settings.hpp"
#include "cli/report/solve_report.hpp"
#include "cli/resolved_scene.hpp"
#include "convex/linear_algebra/pivoted_qr.hpp"
#include "convex/nearest_name.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "mechanics/angles_in_degrees.hpp"

namespace cli::inline sweeps {
namespace {

using convex::Index;
using convex::InvalidInput;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Of a row that depends on others: coefficients below this part of the largest are rounding.
constexpr double rounded_part = 1e-8;

/// The q'' of the equations in which some rows persist, and their multipliers, NaN where other multipliers
/// give the same reaction.
struct HeldMotion {
  convex::Vector q, lambda;
};

/// None where the rows cannot be solved for. Rows that depend on others (two opposite contacts, say) are left
/// out: those that they depend on have no multiplier of their own.
std::optional<HeldMotion> motion_with(const convex::NearestPointProblem& problem,
                                      const std::vector<Index>& rows, const convex::Vector& free) {
  const auto m = static_cast<Index>(rows.size()), n = problem.dimension();
  convex::Matrix U(n, m);
  for (Index k = 0; k < m; ++k) problem.U.copy_row(rows[static_cast<std::size_t>(k)], U.col(k));
  convex::Matrix whitened = U;
  problem.A.whiten_in_place(whitened);
  const convex::linear_algebra::PivotedQr qr(whitened);
  const Index rank = qr.rank;
  convex::Matrix basis(n, rank), directions(n, rank);
  convex::Vector s(rank);
  for (Index k = 0; k < rank; ++k) {
    const Index column = qr.order[static_cast<std::size_t>(k)];
    basis.col(k) = U.col(column);
    directions.col(k) = problem.A.solve(convex::Vector(U.col(column)));
    s[k] = problem.s[rows[static_cast<std::size_t>(column)]];
  }
  std::optional<convex::Metric> gram;
  try {
    const convex::Matrix products = basis.transpose() * directions;
    gram = convex::Metric::dense((products + products.transpose()) / 2);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
  convex::Vector lambda = gram->solve(s - basis.transpose() * free);
  lambda += gram->solve(s - basis.transpose() * (free + directions * lambda));
  HeldMotion found{free + directions * lambda, convex::Vector::Constant(m, no_number)};
  for (Index k = rank; k < m; ++k) {
    const convex::Vector row = U.col(qr.order[static_cast<std::size_t>(k)]),
                         part = gram->solve(directions.transpose() * row);
    const double largest = rank > 0 ? part.cwiseAbs().maxCoeff() : 0;
    for (Index i = 0; i < rank; ++i)
      if (std::abs(part[i]) > rounded_part * largest) lambda[i] = no_number;
  }
  for (Index k = 0; k < rank; ++k) found.lambda[qr.order[static_cast<std::size_t>(k)]] = lambda[k];
  return found;
}

/// `lambda`: of every constraint, those of least norm.
double number_of(const Watched& one, const SolvedScene& solved, const convex::Vector& lambda) {
  const mechanics::GaussSolution& solution = solved.solution;
  switch (one.of) {
    case Watched::Of::acceleration:
      return solution.primal.q[one.index];
    case Watched::Of::multiplier:
      if (solved.is_weighed(static_cast<std::size_t>(one.index))) return no_number;
      return lambda[one.index];
    case Watched::Of::reaction:
      return solution.reaction[one.index];
    case Watched::Of::gauss:
      return solution.gauss;
    case Watched::Of::position:
      return solved.scene.state.q[one.index];
    case Watched::Of::velocity:
      return solved.scene.state.v[one.index];
    case Watched::Of::f:
      return solved.scene.rates->f[one.index];
    case Watched::Of::df:
      return solved.scene.rates->df[one.index];
    case Watched::Of::ddf:
      return solved.second_rates[one.index];
  }
  return no_number;
}

}  // namespace

SweepScene::SweepScene(TomlValue document, std::string file, std::vector<std::string> keys,
                       SceneOptions options)
    : document_(std::move(document)),
      file_(std::move(file)),
      keys_(std::move(keys)),
      options_(std::move(options)) {}

Problem SweepScene::problem(const std::vector<double>& at) {
  std::vector<Setting> settings;
  for (std::size_t k = 0; k < keys_.size(); ++k) settings.push_back(number_setting(keys_[k], at[k]));
  apply_settings(document_, settings);
  return read_problem(document_, directory_of(file_));
}

Scene SweepScene::scene(const std::vector<double>& at) {
  Problem problem = this->problem(at);
  assemble_declared(problem);
  return make_scene(std::move(problem), file_, options_);
}

std::vector<Watched> SweepScene::watched(const std::vector<std::string>& names,
                                         const std::vector<double>& at) {
  const Names known = this->names(at);
  constraints_ = known.constraints;
  std::vector<Watched> all, found;
  const auto add = [&](const char* before, const std::vector<std::string>& names_of, const char* after,
                       Watched::Of of) {
    for (std::size_t k = 0; k < names_of.size(); ++k)
      all.push_back({before + names_of[k] + after, of, static_cast<Index>(k)});
  };
  add("", known.coordinates, "''", Watched::Of::acceleration);
  add("lambda[", known.constraints, "]", Watched::Of::multiplier);
  if (names.empty()) return all;
  add("reaction[", known.coordinates, "]", Watched::Of::reaction);
  all.push_back({"gauss", Watched::Of::gauss, 0});
  if (known.is_mechanism) {
    add("", known.coordinates, "", Watched::Of::position);
    add("", known.coordinates, "'", Watched::Of::velocity);
    add("f[", known.constraints, "]", Watched::Of::f);
    add("df[", known.constraints, "]", Watched::Of::df);
  }
  add("ddf[", known.constraints, "]", Watched::Of::ddf);
  for (const std::string& name : names) {
    const auto known_one =
        std::find_if(all.begin(), all.end(), [&](const Watched& one) { return one.name == name; });
    if (known_one == all.end()) {
      std::vector<std::string> numbers;
      for (const Watched& one : all) numbers.push_back(one.name);
      throw InvalidInput("--watch " + shown(name) + ": there is no such number; " +
                         convex::suggestion(name, numbers));
    }
    found.push_back(*known_one);
  }
  return found;
}

SweepScene::Names SweepScene::names(const std::vector<double>& at) {
  const Problem problem = this->problem(at);
  Names found;
  if (const auto* text = std::get_if<SystemProblem>(&problem.content)) {
    const auto system = mechanics::lagrangian_system(text->system, text->state);
    found.is_mechanism = true;
    found.coordinates = system->coordinates();
    for (const mechanics::Constraint& constraint : system->constraints())
      found.constraints.push_back(constraint.name);
  } else if (const auto* numbers = std::get_if<ProjectionProblem>(&problem.content)) {
    for (Index i = 0; i < numbers->problem.dimension(); ++i)
      found.coordinates.push_back("q[" + std::to_string(i) + "]");
    for (Index a = 0; a < numbers->problem.rows(); ++a)
      found.constraints.push_back("c[" + std::to_string(a) + "]");
  } else {
    throw InvalidInput("no contacts here; `moreau sweep` takes a file with [system] or [projection]");
  }
  return found;
}

std::vector<std::string> SweepScene::angles_in_degrees(const std::vector<std::vector<double>>& points) {
  for (const std::vector<double>& at : points) {
    try {
      const Problem problem = this->problem(at);
      const auto* text = std::get_if<SystemProblem>(&problem.content);
      if (text == nullptr) return {};
      const auto system = mechanics::lagrangian_system(text->system, text->state);
      auto found = mechanics::angles_in_degrees(*system, system->state(text->state));
      if (!found.empty()) return found;
    } catch (const InvalidInput&) {  // the row of the point tells it
    }
  }
  return {};
}

SweepPoint SweepScene::solve(const std::vector<double>& at, const std::vector<Watched>& watched) {
  SweepPoint point;
  point.at = at;
  point.watched.assign(watched.size(), no_number);
  point.error_bound = no_number;
  try {
    Scene scene = this->scene(at);
    ProvedScene resolved = resolve_and_prove(scene, false);
    mechanics::GaussSolution& solution = resolved.found.solution;
    if (scene.written) settle_evaluation_error(scene, solution);
    const SolvedScene solved = solved_scene(scene, solution, 0);
    point.status = name(solution.primal.status);
    point.exit = exit_code(solution.primal.status);
    point.contacts = scene.contacts;
    if (!solved.has_answer()) return point;
    point.error_bound = solution.primal.error_bound;
    point.has_unique_multipliers = solved.multipliers_are_unique();
    for (std::size_t a = 0; a < solved.states.size(); ++a)
      if (solved.states[a] == ConstraintState::persists || solved.states[a] == ConstraintState::touches)
        point.active.push_back(static_cast<Index>(a));
    const convex::Vector lambda = scene.over_constraints(solution.multipliers.least_norm);
    for (std::size_t k = 0; k < watched.size(); ++k) point.watched[k] = number_of(watched[k], solved, lambda);
  } catch (const InvalidInput& error) {
    point.status = "error";
    point.exit = Exit::wrong_input;
    point.message = error.what();
  }
  return point;
}

SweepScene::Margins SweepScene::margins(const std::vector<double>& at, const std::vector<Index>& held) {
  const Scene scene = this->scene(at);
  const std::size_t count = scene.constraints.size();
  const std::vector<double> none(count, no_number);
  Margins found{none, none, none, none, none};
  if (scene.rates)
    for (std::size_t a = 0; a < count; ++a) {
      found.f[a] = scene.rates->f[static_cast<Index>(a)];
      found.df[a] = scene.rates->df[static_cast<Index>(a)];
    }
  std::vector<Index> rows;
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    if (std::find(held.begin(), held.end(), scene.contacts[k]) != held.end())
      rows.push_back(static_cast<Index>(k));
  if (rows.size() != held.size()) return found;
  const convex::Vector free = scene.problem.A.solve(scene.problem.z);
  convex::Vector q = free;
  if (!rows.empty()) {
    const std::optional<HeldMotion> held_motion = motion_with(scene.problem, rows, free);
    if (!held_motion) return found;
    q = held_motion->q;
    for (std::size_t k = 0; k < rows.size(); ++k)
      found.multiplier[static_cast<std::size_t>(scene.contacts[static_cast<std::size_t>(rows[k])])] =
          held_motion->lambda[static_cast<Index>(k)];
  }
  for (std::size_t k = 0; k < scene.contacts.size(); ++k) {
    const auto row = static_cast<Index>(k);
    const auto a = static_cast<std::size_t>(scene.contacts[k]);
    found.slack[a] = scene.problem.U.row(row).dot(q) - scene.problem.s[row];
    found.zero_slack[a] = scene.solve.accuracy.tolerance *
                          (std::abs(scene.problem.s[row]) + scene.problem.U.absolute_dot(row, q.cwiseAbs()));
  }
  return found;
}

}  // namespace cli::inline sweeps
