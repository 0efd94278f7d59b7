#include "cli/scene.hpp"

#include <algorithm>
#include <numeric>

#include "cli/assembled_state.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/numbers_by_constraint.hpp"
#include "cli/problem_file/settings.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/mistakes.hpp"
#include "mechanics/angles_in_degrees.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

mechanics::GaussOptions solve_options(const SceneOptions& options, const SolveSettings& settings) {
  mechanics::GaussOptions made;
  made.always_ranges = options.ranges;
  made.accuracy.reduce = !options.full_model;
  made.accuracy.tolerance = options.tolerance.value_or(settings.tolerance.value_or(made.accuracy.tolerance));
  made.accuracy.limit = options.limit.value_or(made.accuracy.limit);
  const bool from_file = !options.method && settings.method;
  const std::string name = options.method.value_or(settings.method.value_or(std::string(made.method->name)));
  made.method = &require_method(
      name, from_file ? "" : "--method: ", from_file ? std::optional(settings.method_place) : std::nullopt);
  return made;
}

Scene system_scene(const SystemProblem& text, const SolveSettings& settings) {
  std::shared_ptr<const mechanics::LagrangianSystem> system =
      mechanics::lagrangian_system(text.system, text.state);
  mechanics::WrittenMechanism written = mechanics::written_mechanism(system, text.state);
  if (text.declared) written.in_contact = declared_question(*system, *text.declared).contacts;
  std::sort(written.in_contact.begin(), written.in_contact.end());
  std::vector<std::string> constraints;
  std::vector<bool> two_sided;
  for (const mechanics::Constraint& constraint : system->constraints()) {
    constraints.push_back(constraint.name);
    two_sided.push_back(constraint.two_sided);
  }
  try {
    Vector tolerance = contact_tolerances(settings, constraints);
    mechanics::GaussProblem gauss = mechanics::gauss_problem(written, tolerance);
    std::vector<std::string> coordinates = system->coordinates();
    mechanics::State state = written.state;
    return {"",
            "",
            "system",
            std::move(coordinates),
            std::move(constraints),
            std::move(two_sided),
            std::move(gauss.problem),
            std::move(gauss.contacts.present),
            std::move(gauss.contacts.rates),
            std::move(tolerance),
            std::move(system),
            std::move(state),
            {},
            {},
            std::move(written)};
  } catch (const InvalidInput& error) {
    throw mechanics::refused_state(error, text.system.kinetic.begin, *system, written.state);
  }
}

Scene projection_scene(ProjectionProblem numbers) {
  const Index n = numbers.problem.dimension(), m = numbers.problem.rows();
  std::vector<std::string> coordinates, constraints;
  for (Index i = 0; i < n; ++i) coordinates.push_back("q[" + std::to_string(i) + "]");
  for (Index a = 0; a < m; ++a) constraints.push_back("c[" + std::to_string(a) + "]");
  std::vector<bool> two_sided(static_cast<std::size_t>(m), false);
  for (Index a : numbers.problem.two_sided) two_sided[static_cast<std::size_t>(a)] = true;
  mechanics::ExactData exact{std::move(numbers.exact), numbers.are_doubles};
  std::vector<Index> contacts(static_cast<std::size_t>(m));
  std::iota(contacts.begin(), contacts.end(), Index{0});
  return {"",
          "",
          "projection",
          std::move(coordinates),
          std::move(constraints),
          std::move(two_sided),
          std::move(numbers.problem),
          std::move(contacts),
          std::nullopt,
          Vector(),
          nullptr,
          {},
          {},
          std::move(exact)};
}

}  // namespace

std::string directory_of(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? "" : file.substr(0, slash);
}

Vector contact_tolerances(const SolveSettings& settings, const std::vector<std::string>& constraints) {
  return numbers_by_constraint("solve.contact_tolerance",
                               settings.contact_tolerance.value_or(mechanics::default_contact_tolerance),
                               settings.contact_tolerances, constraints);
}

std::string Scene::contact_name(Index row) const {
  const auto k = static_cast<std::size_t>(row);
  if (k >= contacts.size()) return "added row " + std::to_string(k - contacts.size() + 1);
  return constraints[static_cast<std::size_t>(contacts[k])];
}

std::vector<std::string> Scene::contact_names() const {
  std::vector<std::string> chosen;
  for (Index a : contacts) chosen.push_back(constraints[static_cast<std::size_t>(a)]);
  return chosen;
}

std::vector<std::string> Scene::row_names() const {
  std::vector<std::string> names;
  for (Index row = 0; row < problem.rows(); ++row) names.push_back(contact_name(row));
  return names;
}

Vector Scene::over_constraints(const Vector& over_contacts) const {
  Vector all = Vector::Zero(static_cast<Index>(constraints.size()));
  for (std::size_t k = 0; k < contacts.size(); ++k) all[contacts[k]] = over_contacts[static_cast<Index>(k)];
  return all;
}

Problem read_problem_file(const std::string& file, const Overrides& overrides) {
  return read_problem_document(read_document(file), file, overrides);
}

Problem read_problem_document(TomlValue document, const std::string& file, const Overrides& overrides) {
  apply_settings(document, parsed_settings(overrides.settings));
  Problem problem = read_problem(document, directory_of(file));
  assemble_declared(problem, file);
  return problem;
}

Scene make_scene(Problem problem, const std::string& file, const SceneOptions& options) {
  if (!std::holds_alternative<SystemProblem>(problem.content) &&
      !std::holds_alternative<ProjectionProblem>(problem.content))
    throw InvalidInput("no A, z, U and s here; give a file with [system] or [projection]");
  convex::Mistakes mistakes;
  mechanics::GaussOptions solve;
  mistakes.gather([&] { solve = solve_options(options, problem.solve); });
  auto* system = std::get_if<SystemProblem>(&problem.content);
  if (system == nullptr && !problem.solve.contact_tolerances.empty())
    throw InvalidInput("solve.contact_tolerance: by constraint goes with [system] only; take it out",
                       problem.solve.contact_tolerances.front().place);
  std::optional<Scene> made;
  mistakes.gather([&] {
    made = system != nullptr ? system_scene(*system, problem.solve)
                             : projection_scene(std::get<ProjectionProblem>(std::move(problem.content)));
  });
  mistakes.tell();
  Scene& scene = *made;
  scene.file = file;
  scene.title = problem.title;
  scene.solve = solve;
  if (!scene.exact.make) scene.exact.make = [data = scene.problem] { return convex::exact_problem(data); };
  return *std::move(made);
}

Scene read_scene(const std::string& file, const SceneOptions& options, const Overrides& overrides) {
  return make_scene(read_problem_file(file, overrides), file, options);
}

}  // namespace cli
