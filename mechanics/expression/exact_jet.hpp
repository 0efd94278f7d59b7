#pragma once

#include <optional>
#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

using convex::Fraction;

/// A state in fractions.
struct ExactState {
  Fraction t;
  std::vector<Fraction> q, v;
};

/// An expression at a state in fractions, with the derivatives that Lagrange's equations and d²f/dt² need. D
/// is the derivative along the motion at rest of acceleration: D = v·∂/∂q + ∂/∂t. Lists are empty where all
/// is 0.
struct ExactJet {
  Fraction value, along, along_twice;  ///< f, Df, D²f
  std::vector<Fraction> by_q, by_v;    ///< ∂f/∂q, ∂f/∂v: n
  std::vector<Fraction> along_by_v;    ///< ∂Df/∂v, v inside of D held: n
  std::vector<Fraction> by_vv;         ///< ∂²f/∂v∂v: n·n, by rows
};

/// Evaluates nodes of a tape in fractions.
class ExactEvaluation {
 public:
  ExactEvaluation(const Tape& tape, const ExactState& state) : tape_(&tape), state_(&state) {}
  /// None where the value or a derivative is no fraction (a sine of anything but 0, π), or does not exist.
  const std::optional<ExactJet>& operator()(NodeId node);

 private:
  std::optional<ExactJet> evaluated(NodeId node) const;
  ExactJet variable(NodeId node) const;
  const Tape* tape_;
  const ExactState* state_;
  std::vector<std::optional<std::optional<ExactJet>>> known_;
};

/// A text's decimals and fractions are taken as written: 9.81 is 981/100.
std::optional<Fraction> literal_value(const Tape& tape, NodeId node);

}  // namespace mechanics::expression
