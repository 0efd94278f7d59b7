#pragma once

#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/toml_document.hpp"
#include "convex/mistakes.hpp"
#include "convex/nearest_point/methods.hpp"

namespace cli::inline problem_files {

/// `[system]` with its sub-tables, and `[state]` of the same document; tables in files are looked for in
/// `directory`. What is wrong is added to the mistakes; where there are some, so are those of its
/// expressions.
SystemProblem read_system(const TomlValue& document, const std::string& directory,
                          convex::Mistakes& mistakes);

/// `[bodies]`: rigid bodies in space, by their coordinates, their part of T and |e| = 1. What is wrong is
/// added to the mistakes; the names of the bodies are there all the same, if they are told at all.
bool add_bodies(const TomlValue& bodies, mechanics::LagrangianText& system, convex::Mistakes& mistakes);

/// `[projection]`; matrix files are looked for in `directory`.
ProjectionProblem read_projection(const TomlValue& table, const std::string& directory);

/// `[decomposition]`; a matrix file is looked for in `directory`.
DecompositionProblem read_decomposition(const TomlValue& table, const std::string& directory);

/// `[cone]`; a matrix file of the metric is looked for in `directory`.
ConeProblem read_cone(const TomlValue& table, const std::string& directory);

/// `[liquid]` with its parameters.
LiquidProblem read_liquid(const TomlValue& table);

/// `[solve]`; whether the method is one is not asked.
SolveSettings read_solve_settings(const TomlValue& table);

/// The method of a name; otherwise InvalidInput. `option` is "--method: " where the name is not of a file.
const convex::Method& require_method(const std::string& name, const std::string& option,
                                     std::optional<convex::Place> place);

/// The restitution of a constraint, or with an empty name of all.
Restitution read_restitution(const mechanics::Text& constraint, const TomlValue& value,
                             const std::string& where);

/// `[simulate]`.
SimulateSettings read_simulate_settings(const TomlValue& table);

/// `[draw]`.
std::vector<DrawnShape> read_draw(const TomlValue& table);

}  // namespace cli::inline problem_files
