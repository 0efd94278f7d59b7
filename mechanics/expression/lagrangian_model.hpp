#pragma once

#include <memory>
#include <string>
#include <vector>

#include "convex/mistakes.hpp"
#include "mechanics/expression/expansion.hpp"
#include "mechanics/expression/program.hpp"
#include "mechanics/expression/velocity_hessian.hpp"
#include "mechanics/system.hpp"

namespace mechanics::expression {

/// A Lagrangian system read from text: one tape for all its expressions, and what is run of it.
struct LagrangianModel {
  Sources sources;
  Names names;
  Vocabularies meanings;
  std::vector<std::string> coordinates;
  std::vector<Constraint> constraints;

  Tape tape;
  NodeId kinetic = no_node, potential = no_node;  ///< no_node: there is no potential
  std::vector<NodeId> forces;                     ///< by coordinate; no_node where there is none
  std::vector<NodeId> f;                          ///< by constraint
  std::vector<Index> bases;  ///< two-sided constraints whose f stands for the power of it that was written

  /// Group 0: T and, if there is one, V; group 1: the forces that there are.
  Program motion;
  std::vector<Index> forced;  ///< the coordinates that the roots of group 1 belong to
  VelocityHessian hessian;
  /// Group 0: f of every constraint.
  Program contacts;
  /// By slot of `contacts` up to its first operation: the largest |summand| of a variable (0) or constant as
  /// written.
  Values largest_summand_of_constant;
};

/// Parses, expands and checks; throws InvalidInput with the place.
std::unique_ptr<const LagrangianModel> read_lagrangian(const LagrangianText& text);

/// Adds what is wrong in each expression of the text, and of the state, by itself: its form and its names.
void gather_mistakes(const LagrangianText& text, const StateText& state, convex::Mistakes& mistakes);

/// A state of the model, from text.
State read_state(const LagrangianModel& model, const StateText& text);

/// Throws InvalidInput that names the first root, and in it the first subexpression, that is not finite at
/// the values `x` or, for `derivatives` 1 or 2, has no finite first or second derivative. `names`: by root of
/// the group.
[[noreturn]] void refuse_values(const LagrangianModel& model, const Program& program, std::size_t group,
                                const Values& x, int derivatives, const std::vector<std::string>& names);

}  // namespace mechanics::expression
