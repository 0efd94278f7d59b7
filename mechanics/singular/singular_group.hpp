#pragma once

#include "mechanics/added_row.hpp"
#include "mechanics/data_radii.hpp"
#include "mechanics/expression/constraint_series.hpp"
#include "mechanics/row_space.hpp"

namespace mechanics::inline singular_states {

/// Two-sided constraints that hang together by their coordinates, at a state at which some of their gradients
/// vanish or depend on each other, within what rounding leaves of them (docs/theory.md, B.8).
class SingularGroup {
 public:
  using Rounded = expression::Rounded;
  using TimeSeries = expression::TimeSeries;

  /// unit: n, the length that makes a coordinate comparable with the others, 1/sqrt(a_ii). radii: of all
  /// numbers of the state.
  SingularGroup(const LagrangianSystem&, const State&, const StateRadii& radii, const Vector& unit,
                std::vector<Index> constraints);

  /// Whether there is a dependence at all.
  bool is_singular() const { return !dependences_.empty(); }
  const std::vector<Index>& constraints() const { return constraints_; }
  /// The coordinates that they depend on.
  const std::vector<Index>& columns() const { return columns_; }

  /// A gradient that counts as a combination of others, Σ c_b u_b (none: it counts as 0), although the
  /// doubles may differ from it.
  struct Settled {
    Index constraint;
    std::vector<std::pair<Index, double>> combination;  ///< by constraint
    bool by_state = false;      ///< for what the state misses of f = 0 and df/dt = 0, not for rounding alone
    bool is_consistent = true;  ///< d²f/dt² agrees with the same combination
  };
  /// Gradients that vanish, and those that depend on others but for what the state misses.
  std::vector<Settled> settled() const;
  /// A dependence among these constraints, of which d²f/dt² agrees: `main` says nothing that the others do
  /// not.
  struct Repeated {
    Index main;
    std::vector<Index> constraints;
  };
  std::vector<Repeated> repeated() const { return dependent(true); }

  /// Dependences of which d²f/dt² contradicts itself with this velocity, whatever q'' is.
  std::vector<Repeated> contradicted() const { return dependent(false); }

  /// The equations of third derivatives that `q2` (with radii, by coordinate) does not satisfy. Throws
  /// InvalidInput where no equation can make up for it: where third derivatives contradict each other, where
  /// the fourth ones leave several accelerations, or where derivatives up to the fourth do not tell a
  /// constraint that holds by itself from one that does not.
  std::vector<AddedRow> missing(const std::vector<Rounded>& q2);

  /// Whether a derivative that was needed does not exist, so that not all was decided.
  bool is_undecided() const { return undecided_; }

 private:
  std::vector<Repeated> dependent(bool is_consistent) const;
  /// Σ w_a u_a = 0, over the constraints of the group; `main` has the weight 1 before scaling.
  struct Dependence {
    Index main;
    std::vector<Rounded> weights;
    bool vanishes = false;  ///< the gradient of `main` is 0 by itself
    bool by_state = false;  ///< rounding alone does not make it so
  };
  /// 3 Σ w_a (H_a q' + ∂u_a/∂t), over the columns, and what it has to give.
  struct ThirdRow {
    std::vector<Rounded> row;
    Rounded rhs;
    bool is_finite = true, is_added = false;
  };

  Rounded place(Index column) const;
  Rounded velocity(Index column) const;
  std::vector<TimeSeries> coordinates_along(const std::vector<Rounded>& q2) const;
  TimeSeries time_along() const;
  std::vector<TimeSeries> along(const std::vector<Rounded>& q2, int order) const;
  std::vector<TimeSeries> along_column(std::size_t column, int order, bool accelerated) const;
  void find_dependences();
  void find_what_state_misses(const RowMatrix& gradients);
  void find_third_rows();
  Rounded third(std::size_t dependence, const std::vector<TimeSeries>& f) const;
  std::vector<AddedRow> test_fourth(std::size_t k, const std::vector<Rounded>& q2);
  std::vector<AddedRow> linear_forms(const Dependence&) const;
  std::optional<bool> holds_by_itself(const Dependence&) const;
  /// Whether the constraints of a dependence vanish on some motion with this q'', and the order of the
  /// derivatives of f that decide it. sign: of the form that fourth derivatives are, which is 0 here and has
  /// one sign elsewhere. None where no order does.
  struct Motion {
    bool exists;
    int order;
  };
  std::optional<Motion> motion_with(const Dependence&, const std::vector<Rounded>& q2, double sign) const;
  [[noreturn]] void refuse(const Dependence&, const std::string& what) const;

  const LagrangianSystem& system_;
  State state_;
  StateRadii radii_;
  std::vector<Index> constraints_;
  expression::ConstraintSeries series_;
  std::vector<Index> columns_;
  Vector unit_;                                    // by column
  double missed_place_ = 0, missed_velocity_ = 0;  // how far q and q' are from f = 0 and df/dt = 0, in units
  RowSpace held_;  // the independent gradients, then the independent third rows
  std::vector<Index> independent_;
  std::vector<Dependence> dependences_;
  std::vector<ThirdRow> third_;
  SplitRows split_;  // of the third rows
  bool undecided_ = false;
};

}  // namespace mechanics::inline singular_states
