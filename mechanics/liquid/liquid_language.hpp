#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/expression/expansion.hpp"
#include "mechanics/liquid/field.hpp"
#include "mechanics/liquid/liquid_text.hpp"

namespace mechanics::liquid {

/// The expressions of a liquid: in its coordinates and parameters, on one tape.
class LiquidLanguage {
 public:
  LiquidLanguage(const std::vector<Text>& coordinates, const std::vector<NamedText>& parameters,
                 const std::optional<ParameterRange>& range = {});
  LiquidLanguage(const LiquidLanguage&) = delete;
  LiquidLanguage& operator=(const LiquidLanguage&) = delete;

  /// An expression in coordinates and parameters; `what` names it in messages.
  expression::NodeId node(const Text&, const std::string& what);
  /// An expression in parameters alone.
  double number(const Text&, const std::string& what);
  /// The same with what rounding may have done to it; decimals count as written.
  expression::Rounded rounded(const Text&, const std::string& what);
  Field field(const Text&, const std::string& what);
  Field field(expression::NodeId, const std::string& what, convex::Place) const;

  // Sums and products of nodes, no_node being 0.
  expression::NodeId sum(expression::NodeId, expression::NodeId);
  expression::NodeId difference(expression::NodeId, expression::NodeId);
  expression::NodeId product(expression::NodeId, expression::NodeId);
  /// ∂ node/∂ coordinate j; no_node where the text does not depend on it.
  std::vector<expression::NodeId> gradient(expression::NodeId);
  /// The value of a parameter of the file.
  double parameter(const std::string& name);

  const std::vector<std::string>& coordinates() const { return coordinates_; }

 private:
  void declare(const Text&, const char* what, expression::Name);
  void give_range(const ParameterRange&);
  expression::Sources sources_;
  expression::Names names_;
  expression::Vocabularies meanings_;
  expression::Tape tape_;
  expression::Expansion expansion_;
  std::vector<std::string> coordinates_;
};

}  // namespace mechanics::liquid
