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

namespace cli::inline sweeps {
namespace {

using convex::Index;
using convex::InvalidInput;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::optional<Index> place_of(const std::vector<std::string>& names, const std::string& name) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return static_cast<Index>(k);
  return std::nullopt;
}

/// "lambda[floor]" begins with "lambda[" and ends with "]": what stands within.
std::optional<std::string> within(const std::string& name, const std::string& prefix) {
  if (name.rfind(prefix, 0) != 0 || name.back() != ']') return std::nullopt;
  return name.substr(prefix.size(), name.size() - prefix.size() - 1);
}

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

}  // namespace

SweepScene::SweepScene(TomlValue document, std::string file, std::vector<std::string> keys,
                       SceneOptions options)
    : document_(std::move(document)),
      file_(std::move(file)),
      keys_(std::move(keys)),
      options_(std::move(options)) {}

Scene SweepScene::scene(const std::vector<double>& at) {
  std::vector<Setting> settings;
  for (std::size_t k = 0; k < keys_.size(); ++k) settings.push_back(number_setting(keys_[k], at[k]));
  apply_settings(document_, settings);
  Problem problem = read_problem(document_, directory_of(file_));
  assemble_declared(problem);
  return make_scene(std::move(problem), file_, options_);
}

std::vector<Watched> SweepScene::watched(const std::vector<std::string>& names,
                                         const std::vector<double>& at) {
  const Names known = this->names(at);
  constraints_ = known.constraints;
  std::vector<Watched> found;
  if (names.empty()) {
    for (std::size_t i = 0; i < known.coordinates.size(); ++i)
      found.push_back({known.coordinates[i] + "''", Watched::Of::acceleration, static_cast<Index>(i)});
    for (std::size_t a = 0; a < known.constraints.size(); ++a)
      found.push_back(
          {"lambda[" + known.constraints[a] + "]", Watched::Of::multiplier, static_cast<Index>(a)});
  }
  for (const std::string& name : names) {
    std::optional<Index> place;
    if (name == "gauss") {
      found.push_back({name, Watched::Of::gauss, 0});
      continue;
    }
    Watched::Of of = Watched::Of::acceleration;
    if (const auto constraint = within(name, "lambda[")) {
      of = Watched::Of::multiplier;
      place = place_of(known.constraints, *constraint);
    } else if (const auto coordinate = within(name, "reaction[")) {
      of = Watched::Of::reaction;
      place = place_of(known.coordinates, *coordinate);
    } else if (name.size() > 2 && name.compare(name.size() - 2, 2, "''") == 0) {
      place = place_of(known.coordinates, name.substr(0, name.size() - 2));
    }
    if (!place) {
      std::vector<std::string> numbers{"gauss"};
      for (const std::string& coordinate : known.coordinates) {
        numbers.push_back(coordinate + "''");
        numbers.push_back("reaction[" + coordinate + "]");
      }
      for (const std::string& constraint : known.constraints) numbers.push_back("lambda[" + constraint + "]");
      throw InvalidInput("--watch " + shown(name) + ": there is no such number; " +
                         convex::suggestion(name, numbers));
    }
    found.push_back({name, of, *place});
  }
  return found;
}

SweepScene::Names SweepScene::names(const std::vector<double>& at) {
  std::vector<Setting> settings;
  for (std::size_t k = 0; k < keys_.size(); ++k) settings.push_back(number_setting(keys_[k], at[k]));
  apply_settings(document_, settings);
  const Problem problem = read_problem(document_, directory_of(file_));
  Names found;
  if (const auto* text = std::get_if<SystemProblem>(&problem.content)) {
    const auto system = mechanics::lagrangian_system(text->system);
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
    for (std::size_t k = 0; k < watched.size(); ++k) {
      const Watched& one = watched[k];
      switch (one.of) {
        case Watched::Of::acceleration:
          point.watched[k] = solution.primal.q[one.index];
          break;
        case Watched::Of::multiplier:
          if (!solved.is_weighed(static_cast<std::size_t>(one.index))) point.watched[k] = lambda[one.index];
          break;
        case Watched::Of::reaction:
          point.watched[k] = solution.reaction[one.index];
          break;
        case Watched::Of::gauss:
          point.watched[k] = solution.gauss;
      }
    }
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
