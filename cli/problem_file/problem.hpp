#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/problem_file/toml_document.hpp"
#include "convex/cones/exact_metric.hpp"
#include "convex/gamma0/call.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"
#include "convex/proved_prox/proved_split.hpp"
#include "mechanics/lagrangian_text.hpp"
#include "mechanics/liquid/liquid_text.hpp"

namespace cli::inline problem_files {

/// A number that a file gives for a constraint, or for a family of them.
struct NamedNumber {
  std::string constraint;
  convex::Place place;
  double value = 0;
};

/// A coefficient of restitution, of a constraint or a family of them: a number, or an expression in the
/// parameters.
struct Restitution {
  std::string constraint;  ///< "": of all that have none of their own
  convex::Place place;
  std::string where;  ///< its name in messages
  mechanics::Text e;
};

/// What `[state]` declares: the state given is a guess at one with these contacts.
struct DeclaredState {
  std::vector<std::string> in_contact;
  std::optional<std::vector<std::string>> solve_for;  ///< the coordinates that move; none: all
  convex::Place place;
};

/// `[system]` and `[state]`: a mechanical system by its Lagrangian data.
struct SystemProblem {
  mechanics::LagrangianText system;
  mechanics::StateText state;
  std::vector<Restitution> restitutions;  ///< that [system.looseness] gives to its constraints
  std::optional<DeclaredState> declared = {};
};

/// `[projection]`: the same problem from numbers.
struct ProjectionProblem {
  convex::NearestPointProblem problem;
  bool are_doubles = true;  ///< no number was written as anything but a double
  std::function<convex::ExactProblem()> exact =
      {};  ///< the numbers as written; none when they are the doubles
};

/// `[decomposition]`: a point to split into prox_f z and prox_g z, g the conjugate of f in the metric W.
struct DecompositionProblem {
  convex::Vector z;
  convex::Metric W;
  convex::Call f;
  std::function<convex::SplitQuestion()> exact = {};  ///< the same with its numbers as they are written
};

/// `[cone]`: a polyhedral cone in n dimensions, and a point to split between it and its polar in the metric
/// W.
struct ConeProblem {
  bool by_halfspaces = false;
  convex::ExactRows rows;     ///< generators, or half-spaces a·x <= 0
  convex::ExactRows two_way;  ///< lines, or equations
  convex::Index n = 0;
  std::optional<convex::ExactVector> z;
  convex::ExactMetric W;
};

/// `[liquid]`: an incompressible liquid at an instant.
struct LiquidProblem {
  mechanics::liquid::LiquidText text;
};

/// `[solve]`: what a file says about how to solve it.
struct SolveSettings {
  std::optional<std::string> method;
  convex::Place method_place;
  std::optional<double> tolerance;
  std::optional<double> contact_tolerance;
  convex::Place contact_tolerance_place;
  std::vector<NamedNumber> contact_tolerances;
};

/// `[simulate]`: the motion of a system.
struct SimulateSettings {
  std::optional<mechanics::Text> until;  ///< an expression in the parameters
  std::optional<std::string> method;
  convex::Place method_place;
  std::optional<double> tolerance;
  convex::Place tolerance_place;
  std::optional<double> step;
  convex::Place step_place;
  std::vector<Restitution> restitutions;
  std::optional<long> samples;
  std::optional<std::string> impact_law;
  convex::Place impact_law_place;
};

/// Something of `[draw]`: its numbers are expressions in coordinates, parameters, definitions and t. A point
/// has x and y, a segment those of its two ends, a circle those of its centre, and its radius.
struct DrawnShape {
  enum class Kind { point, segment, circle };
  Kind kind;
  mechanics::Text name;  ///< of one, or of a family
  std::vector<mechanics::Text> numbers;
};

/// A problem file as plain data.
struct Problem {
  std::string title;
  std::variant<SystemProblem, ProjectionProblem, DecompositionProblem, ConeProblem, LiquidProblem> content;
  SolveSettings solve;
  SimulateSettings simulate;
  std::vector<DrawnShape> draw;
};

/// Reads a problem; `directory` is where the files that it names are looked for. Throws InvalidInput with the
/// place.
Problem read_problem(const TomlValue& document, const std::string& directory);
Problem read_problem(const std::string& text, const std::string& directory);

/// The bytes of a file, or of standard input for "-". Throws InvalidInput when it cannot be read.
std::string read_file(const std::string& path);

}  // namespace cli::inline problem_files
