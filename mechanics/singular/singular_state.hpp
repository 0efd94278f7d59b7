#pragma once

#include "convex/nearest_point/problem.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/singular/singular_group.hpp"
#include "mechanics/warning.hpp"

namespace mechanics::inline singular_states {

/// A state at which gradients of two-sided constraints may vanish or depend on each other. Second derivatives
/// then do not fix q''; those of third order are linear in it and are added, in the order of need; those of
/// fourth order can only refuse (docs/theory.md, B.8).
class SingularState {
 public:
  /// Looks at the two-sided rows of Gauss' problem at this state. Costs little where they are clearly
  /// independent.
  SingularState(const LagrangianSystem&, const State&, const StateRadii&, const GaussProblem&);

  /// Whether there is anything that could need other equations.
  bool may_add_rows() const { return !groups_.empty() || !unseen_.empty() || !too_many_.empty(); }

  /// The problem with 0·q'' >= 0 in place of its one-sided rows.
  convex::NearestPointProblem without_one_sided(const convex::NearestPointProblem&) const;

  /// Rows of gradients that count as 0, or as a combination of others for the digits of the state, are made
  /// so; so are their bounds, unless these contradict.
  /// Returns whether there were any.
  bool settle(convex::NearestPointProblem&) const;

  /// The problem without the gradients that others make up, 0·q'' = 0 in their place: for a solver that finds
  /// a contradiction, or no end, in their rounding. None where there are none, or where they were left out
  /// before.
  std::optional<convex::NearestPointProblem> without_repeated(const convex::NearestPointProblem&);

  /// The equations that an answer of the problem, with those added before, does not satisfy; none: it stands.
  /// Throws InvalidInput as SingularGroup::missing does.
  std::vector<AddedRow> missing(const convex::NearestPointProblem&, const GaussSolution&);

  /// The problem with these equations as its last rows, two-sided. The gradient that the others of the
  /// weights make up is left out, 0·q'' = 0: its multiplier is not given, and its rounding might contradict
  /// the others.
  convex::NearestPointProblem extended(const convex::NearestPointProblem&,
                                       const std::vector<AddedRow>&) const;

  /// What is to be said of an answer that stands. `added`: all equations that it was given; `infeasible`: it
  /// is that there is none.
  std::vector<Warning> warnings(const std::vector<AddedRow>& added, bool infeasible) const;

 private:
  void look_at(const std::vector<Index>& suspects);
  void look_at_rest(const GaussSolution&);

  const LagrangianSystem& system_;
  State state_;
  StateRadii radii_;
  Vector unit_;
  std::vector<Index> two_sided_;  ///< constraints
  std::vector<Index> row_of_;     ///< by constraint: its row of the problem, -1 without
  std::vector<SingularGroup> groups_;
  std::vector<Index> unseen_;    ///< constraints of groups too large for a first look
  std::vector<Index> too_many_;  ///< dependent ones of groups too large for any
  bool left_out_ = false;        ///< rows that others make up
};

}  // namespace mechanics::inline singular_states
