#pragma once

#include <optional>
#include <vector>

#include "mechanics/expression/number.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// A state in fractions, or in balls where it is none.
struct ExactState {
  Number t;
  std::vector<Number> q, v;
};

/// An expression at a state, nothing rounded without a bound, with the derivatives that Lagrange's equations
/// and d²f/dt² need. D is the derivative along the motion at rest of acceleration: D = v·∂/∂q + ∂/∂t. Lists
/// are empty where all is 0.
struct ExactJet {
  Number value, along, along_twice;  ///< f, Df, D²f
  std::vector<Number> by_q, by_v;    ///< ∂f/∂q, ∂f/∂v: n
  std::vector<Number> along_by_v;    ///< ∂Df/∂v, v inside of D held: n
  std::vector<Number> by_vv;         ///< ∂²f/∂v∂v: n·n, by rows
};

/// What of a jet is evaluated: f and Df, or everything.
enum class JetPart { rates, whole };

/// Evaluates nodes of a tape in fractions and, when `precision` (bits) is not 0, in balls where fractions
/// end.
class ExactEvaluation {
 public:
  ExactEvaluation(const Tape& tape, const ExactState& state, long precision, JetPart part = JetPart::whole)
      : tape_(&tape), state_(&state), precision_(precision), part_(part) {}
  /// None where the value or a derivative does not exist (for all that balls tell), or, without balls, is no
  /// fraction (a sine of anything but 0, π).
  const std::optional<ExactJet>& operator()(NodeId node);

 private:
  std::optional<ExactJet> evaluated(NodeId node) const;
  std::optional<ExactJet> branch(NodeId node) const;
  ExactJet variable(NodeId node) const;
  const Tape* tape_;
  const ExactState* state_;
  long precision_;
  JetPart part_;
  std::vector<std::optional<std::optional<ExactJet>>> known_;
};

/// A text's decimals and fractions are taken as written: 9.81 is 981/100.
std::optional<Fraction> literal_value(const Tape& tape, NodeId node);

}  // namespace mechanics::expression
