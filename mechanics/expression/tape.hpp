#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "mechanics/expression/operation.hpp"
#include "mechanics/expression/source.hpp"

namespace mechanics::expression {

using NodeId = std::uint32_t;
inline constexpr NodeId no_node = std::numeric_limits<NodeId>::max();

/// In the text of a literal: what follows is its radius and, after a second mark, the fraction that it is
/// (see rounded_nodes.hpp).
inline constexpr char radius_mark = '~';

/// Which variables a node depends on, as bits; a constant has none.
enum Dependence : std::uint8_t { on_nothing = 0, on_coordinates = 1, on_velocities = 2, on_time = 4 };

/// Expressions as one acyclic graph: a node comes after its operands, and equal nodes are one node.
/// Nothing is simplified, but that the lesser, or the greater, of two equal operands is one of them: between
/// equal branches there is no choice. The values of constants are computed as they are made, their nodes are
/// kept. A constant with an undefined operand is NaN.
class Tape {
 public:
  NodeId literal(std::string_view text, double number, Origin origin);
  NodeId pi(Origin origin);
  /// A parameter stands for the node that gives its value.
  NodeId parameter(std::string_view name, NodeId meaning, Origin origin);
  NodeId coordinate(std::uint32_t i, Origin origin);
  NodeId velocity(std::uint32_t i, Origin origin);
  NodeId time(Origin origin);
  /// A unary operation has b = a.
  NodeId apply(Operation operation, NodeId a, NodeId b, Origin origin);

  std::size_t size() const { return operation_.size(); }
  Operation operation(NodeId node) const { return operation_[node]; }
  /// The operands; of a variable, a is its number.
  NodeId a(NodeId node) const { return a_[node]; }
  NodeId b(NodeId node) const { return b_[node]; }
  std::uint8_t depends(NodeId node) const { return depends_[node]; }
  bool is_constant(NodeId node) const { return depends_[node] == on_nothing; }
  double constant(NodeId node) const { return value_[node]; }
  Origin origin(NodeId node) const { return origin_[node]; }
  /// A number whose sign 0 lies between two branches that need not fit together (if, step, sign).
  void note_edge(NodeId node) { edges_.insert(node); }
  bool is_edge(NodeId node) const { return edges_.count(node) > 0; }
  bool has_branches() const { return has_branches_; }
  /// Constants have radii that count: choices by the sign of one are kept, as nodes.
  void keep_choices() { keeps_choices_ = true; }
  bool is_chosen(NodeId sign) const { return is_constant(sign) && !keeps_choices_; }
  /// The text of a literal or the name of a parameter.
  const std::string& text(NodeId node) const;

 private:
  NodeId find_or_add(Operation operation, NodeId a, NodeId b, Origin origin, double value,
                     std::uint8_t depends);
  std::uint32_t text_number(std::string_view text);
  void grow_table();
  /// Is x one of the operands of a chain of minima, or of maxima, or the node itself?
  bool chooses_among(Operation operation, NodeId chain, NodeId x) const;
  std::vector<Operation> operation_;
  std::vector<NodeId> a_, b_;
  std::vector<double> value_;
  std::vector<std::uint8_t> depends_;
  std::vector<Origin> origin_;
  std::vector<NodeId> table_ = std::vector<NodeId>(1024, no_node);  // open addressing, a power of two
  std::unordered_map<std::string, std::uint32_t> text_numbers_;
  std::vector<std::string> texts_;
  std::unordered_set<NodeId> edges_;
  bool has_branches_ = false, keeps_choices_ = false;
};

/// The expression of a node as text, cut to about 60 characters.
std::string written(const Tape& tape, NodeId node, const std::vector<std::string>& coordinates);

}  // namespace mechanics::expression
