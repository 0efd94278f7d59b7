#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/problem_file/problem.hpp"
#include "mechanics/certified_solution.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/singular/singular_group.hpp"
#include "mechanics/written_mechanism.hpp"

namespace cli {

/// A problem file made ready to solve: names, the nearest-point problem over the contacts K, and, for a
/// mechanical system, the system and its state.
struct Scene {
  std::string file, title, kind;
  std::vector<std::string> coordinates;
  std::vector<std::string> constraints;  ///< every constraint of the file
  std::vector<bool> two_sided;           ///< one per constraint
  convex::NearestPointProblem problem;  ///< its row k is constraint contacts[k]; after them, those of `added`
  std::vector<convex::Index> contacts;  ///< K, indices of constraints
  std::optional<mechanics::ConstraintRates> rates;
  convex::Vector contact_tolerance;  ///< one per constraint, of a system
  std::shared_ptr<const mechanics::LagrangianSystem> system;
  mechanics::State state;
  mechanics::GaussOptions solve;
  mechanics::ExactData exact = {};  ///< the problem at its exact values
  /// A mechanism as its text has it, for what is proved or estimated from there.
  std::optional<mechanics::WrittenMechanism> written = {};

  /// Equations of third derivatives that the state needed.
  std::vector<mechanics::AddedRow> added = {};
  /// Rows were changed within what rounding or the digits of the state leave of them.
  bool is_settled = false;

  /// The constraint of a row, or "added row 1" and so on.
  std::string contact_name(convex::Index row) const;
  std::vector<std::string> contact_names() const;
  /// Of all rows of the problem, those of `added` included.
  std::vector<std::string> row_names() const;
  /// Numbers over K spread over all constraints, 0 elsewhere.
  convex::Vector over_constraints(const convex::Vector& over_contacts) const;
};

/// The tolerance of each constraint by `[solve] contact_tolerance`.
convex::Vector contact_tolerances(const SolveSettings&, const std::vector<std::string>& constraints);

/// Where the files that a problem file names are looked for.
std::string directory_of(const std::string& file);

/// Reads a problem file, with what is set in it; its matrix files are looked for beside it. A state that
/// declares contacts is assembled, and what that moved is told on standard error.
Problem read_problem_file(const std::string& file, const Overrides& overrides);
/// The same of what was read of `file`, or is called so.
Problem read_problem_document(TomlValue document, const std::string& file, const Overrides& overrides);

/// The scene of a [system] or a [projection]; options of the command line win over the file's [solve].
Scene make_scene(Problem, const std::string& file, const SceneOptions& options);

/// Both in one. Throws InvalidInput when the file holds another kind of problem.
Scene read_scene(const std::string& file, const SceneOptions& options, const Overrides& overrides = {});

}  // namespace cli
