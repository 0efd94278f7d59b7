#pragma once

#include <string>

#include "cli/report/answer.hpp"
#include "cli/scene.hpp"
#include "mechanics/warning.hpp"

namespace cli {
class JsonWriter;
}

namespace cli::inline reports {

/// Whether a constraint persists, does so without pressing for any choice of multipliers, opens, or is not in
/// K.
enum class ConstraintState { persists, touches, opens, inactive };

/// A solved scene, as its reports need it.
struct SolvedScene {
  const Scene& scene;
  const mechanics::GaussSolution& solution;
  std::vector<ConstraintState> states;  ///< one per constraint
  convex::Vector second_rates;          ///< d²f_a/dt², one per constraint
  double seconds = 0;
  bool sensitivity = false;   ///< whether its report is wanted
  bool null_space = false;    ///< whether that of the multipliers is
  bool verbose = false;       ///< whether the text tells how the answer was found
  bool asked_method = false;  ///< whether a method was named
  /// The error bound for A, z, U, s as evaluated, when that of the solution counts their rounding too.
  std::optional<double> as_evaluated = {};
  std::optional<convex::Certificate> certificate = {};   ///< when a proof was asked for
  const mechanics::ExactGaussSolution* exact = nullptr;  ///< when it was found in fractions
  convex::IntegerVector farkas = {};                     ///< exact weights, when these alone were proved
  const mechanics::TextProof* text = nullptr;            ///< when it was proved from the text of a mechanism
  std::vector<mechanics::Warning> warnings = {};         ///< what its numbers do not show
  /// Constraints that count as closed by contact_tolerance alone: the mechanism as written has gaps there.
  std::vector<convex::Index> closed_by_tolerance = {};
  bool on_edge = false;  ///< the state stands between two branches of an expression

  /// Whether an added row weighs this constraint: its multiplier then grows without bound near the state.
  bool is_weighed(std::size_t constraint) const;
  /// Whether the multipliers that are given are unique.
  bool multipliers_are_unique() const;
  /// Of a row of the problem; an added row persists.
  ConstraintState state_of_row(convex::Index row) const;
  bool infeasible() const { return solution.primal.status == convex::Status::infeasible; }
  bool has_answer() const {
    return solution.multipliers.least_norm.size() == scene.problem.rows() && !infeasible();
  }
};

/// Adds to the error bound what the rounding of A, z, U, s of a mechanism amounts to; the bound without it,
/// where there is an answer to a mechanism without added rows.
std::optional<double> count_evaluation_error(const Scene&, mechanics::GaussSolution&);

SolvedScene solved_scene(const Scene&, const mechanics::GaussSolution&, double seconds);

/// w·s of the weights that prove a contradiction, for the numbers as written.
double left_of_contradiction(const SolvedScene&);

/// Adds what is to be said of a mechanism beside `singular` states: contacts that are nearly there, contacts
/// that only touch, and an edge between branches.
void add_contact_warnings(SolvedScene&);

const char* name(ConstraintState);

/// The keys of docs/problem-files.md, into the object that is open.
void write_solved(JsonWriter&, const SolvedScene&);

/// The object, one line without its end.
std::string solve_json(const SolvedScene&);

/// The readable result.
std::string solve_text(const SolvedScene&);

}  // namespace cli::inline reports
