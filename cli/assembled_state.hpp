#pragma once

#include <string>
#include <vector>

#include "cli/problem_file/problem.hpp"
#include "mechanics/assembly.hpp"

namespace cli {

/// Constraints and coordinates by their names; a family's name stands for all its members. Throws
/// InvalidInput for a name that there is not. `what`: "--contact", for the message.
std::vector<mechanics::Index> constraints_named(const mechanics::LagrangianSystem&,
                                                const std::vector<std::string>& names,
                                                const std::string& what);
std::vector<mechanics::Index> coordinates_named(const mechanics::LagrangianSystem&,
                                                const std::vector<std::string>& names,
                                                const std::string& what);

/// The contacts that [state] declares, and the coordinates that it does not let move.
mechanics::AssemblyQuestion declared_question(const mechanics::LagrangianSystem&, const DeclaredState&);

/// A state as the text of its numbers, with all their digits.
mechanics::StateText state_text(const mechanics::LagrangianSystem&, const mechanics::State&,
                                const mechanics::StateText& before);

/// "f and g exclude each other": what `fighting` says.
std::string fighting_text(const mechanics::LagrangianSystem&, const std::vector<mechanics::Index>& fighting);

/// "y = 0.5": where the positions are.
std::string position_text(const mechanics::LagrangianSystem&, const mechanics::State&);

/// Where [state] declares contacts, or what to solve for: the nearest such state takes its place, and
/// standard error tells by how much position and velocity changed. Throws InvalidInput when there is none.
void assemble_declared(Problem&, const std::string& file);

/// How far a state was moved, in the kinetic metric of the one given.
struct Moved {
  double position = 0, velocity = 0;
};

Moved moved_from(const mechanics::LagrangianSystem&, const mechanics::State& given,
                 const mechanics::Assembly& found);

/// The same, without telling; none where nothing is declared.
std::optional<Moved> assemble_declared(Problem&);

}  // namespace cli
