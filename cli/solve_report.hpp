#pragma once

#include <string>

#include "cli/answer.hpp"
#include "cli/scene.hpp"

namespace cli {

class JsonWriter;

/// Whether a constraint persists, opens, or is not in K.
enum class ConstraintState { persists, opens, inactive };

/// A solved scene, as its reports need it.
struct SolvedScene {
  const Scene& scene;
  const mechanics::GaussSolution& solution;
  std::vector<ConstraintState> states;  ///< one per constraint
  convex::Vector second_rates;          ///< d²f_a/dt², one per constraint
  double seconds = 0;
  bool sensitivity = false;                              ///< whether its report is wanted
  bool null_space = false;                               ///< whether that of the multipliers is
  std::optional<convex::Certificate> certificate = {};   ///< when a proof was asked for
  const mechanics::ExactGaussSolution* exact = nullptr;  ///< when it was found in fractions
  convex::IntegerVector farkas = {};                     ///< exact weights, when these alone were proved
  const mechanics::TextProof* text = nullptr;            ///< when it was proved from the text of a mechanism

  bool infeasible() const { return solution.primal.status == convex::Status::infeasible; }
  bool has_answer() const {
    return solution.multipliers.least_norm.size() == scene.problem.rows() && !infeasible();
  }
};

SolvedScene solved_scene(const Scene&, const mechanics::GaussSolution&, double seconds);

const char* name(ConstraintState);

/// The keys of docs/problem-files.md, into the object that is open.
void write_solved(JsonWriter&, const SolvedScene&);

/// The object, one line without its end.
std::string solve_json(const SolvedScene&);

/// The readable result.
std::string solve_text(const SolvedScene&);

}  // namespace cli
