#include "mechanics/expression/state_nodes.hpp"

#include "mechanics/expression/assignment.hpp"
#include "mechanics/expression/construction.hpp"
#include "mechanics/expression/lexer.hpp"

namespace mechanics::expression {
namespace {

bool refers_or_decides(const Names& names, const Text& text) {
  Sources sources;
  Lexer lexer(sources.add(text, "state"));
  for (Token token = lexer.next(); token.kind != Token::Kind::end; token = lexer.next()) {
    if (token.kind == Token::Kind::prime) return true;
    if (token.kind != Token::Kind::name) continue;
    if (token.text == "point") return true;  // of a body, whose coordinates it uses
    if (token.text == "if" || token.text == "step" || token.text == "sign") return true;
    const Name* meaning = names.find(token.text);
    if (meaning != nullptr && meaning->kind != Name::Kind::parameter) return true;
  }
  return false;
}

/// Copies nodes to a tape of constants; t, coordinates and velocities become what the state gives for them.
class StateSubstitution {
 public:
  StateSubstitution(const LagrangianModel& model, const StateText& text, const Tape& from, NodeId t,
                    std::vector<NodeId> q, std::vector<NodeId> v, Tape& to)
      : model_(model),
        place_(text.position_table ? std::optional(text.position_table->begin) : std::nullopt),
        from_(from),
        given_{std::move(q), std::move(v), {t}},
        to_(to) {}

  NodeId instant() { return given(2, 0); }
  NodeId position(std::size_t i) { return given(0, i); }
  NodeId velocity(std::size_t i) { return given(1, i); }

 private:
  NodeId given(std::size_t kind, std::size_t i) {
    const NodeId root = given_[kind][i];
    return root == no_node ? no_node : copy(root);
  }

  /// The node that stands for a variable; no_node where that is 0, a velocity at rest or t.
  NodeId meaning(NodeId variable) const {
    if (from_.operation(variable) == Operation::time) return given_[2][0];
    const bool is_velocity = from_.operation(variable) == Operation::velocity;
    const std::size_t i = from_.a(variable);
    const NodeId found = given_[is_velocity ? 1 : 0][i];
    if (found == no_node && !is_velocity)
      throw convex::InvalidInput(
          "position: " + quoted(model_.coordinates[i]) + " is used and not given; give every coordinate",
          place_);
    return found;
  }

  NodeId copy(NodeId root) {
    known_.resize(from_.size(), no_node);
    open_.resize(from_.size(), false);
    std::vector<NodeId> stack{root};
    while (!stack.empty()) {
      const NodeId node = stack.back();
      if (known_[node] != no_node) {
        stack.pop_back();
        continue;
      }
      const Operation operation = from_.operation(node);
      const bool is_variable = operation == Operation::time || operation == Operation::coordinate ||
                               operation == Operation::velocity;
      std::vector<NodeId> below;
      if (is_variable) {
        if (const NodeId stands = meaning(node); stands != no_node) below.push_back(stands);
      } else {
        if (arity(operation) >= 1 || operation == Operation::parameter) below.push_back(from_.a(node));
        if (arity(operation) == 2) below.push_back(from_.b(node));
      }
      const std::size_t before = stack.size();
      for (const NodeId next : below)
        if (known_[next] == no_node) stack.push_back(next);
      if (stack.size() == before) {
        known_[node] = copied(node, below);
        stack.pop_back();
        continue;
      }
      if (is_variable && open_[node])
        throw convex::InvalidInput("state: the value of " + quoted(written(from_, node, model_.coordinates)) +
                                       " needs itself; give one of them as a number",
                                   place_);
      open_[node] = true;
    }
    return known_[root];
  }

  NodeId copied(NodeId node, const std::vector<NodeId>& below) {
    const Origin at = from_.origin(node);
    switch (const Operation operation = from_.operation(node)) {
      case Operation::literal:
        return to_.literal(from_.text(node), from_.constant(node), at);
      case Operation::pi:
        return to_.pi(at);
      case Operation::parameter:
        return to_.parameter(from_.text(node), known_[below[0]], at);
      case Operation::time:
      case Operation::coordinate:
      case Operation::velocity:
        return below.empty() ? to_.literal("0", 0, at) : known_[below[0]];
      case Operation::where_negative:
      case Operation::where_not_negative: {
        const auto sign = sign_as_written(to_, known_[below[0]]);
        if (!sign) return to_.apply(operation, known_[below[0]], known_[below[1]], at);
        const bool counts = (*sign < 0) == (operation == Operation::where_negative);
        return counts ? known_[below[1]] : to_.literal("0", 0, at);
      }
      default:
        return to_.apply(operation, known_[below.front()], known_[below.back()], at);
    }
  }

  const LagrangianModel& model_;
  std::optional<convex::Place> place_;  // definitions lie elsewhere, so that the state's own is said
  const Tape& from_;
  std::vector<NodeId> given_[3];  // positions, velocities, t
  Tape& to_;
  std::vector<NodeId> known_;
  std::vector<bool> open_;
};

}  // namespace

bool needs_nodes(const LagrangianModel& model, const StateText& text) {
  for (const auto* table : {&text.position, &text.velocity})
    for (const NamedText& entry : *table)
      if (refers_or_decides(model.names, entry.value)) return true;
  return text.t && refers_or_decides(model.names, *text.t);
}

StateNodes state_nodes(const LagrangianModel& model, const StateText& text) {
  StateNodes found;
  Tape tape;
  Expansion expansion(model.meanings, tape);
  const auto& families = model.meanings.coordinate_families;
  const auto nodes = [&](const std::vector<NamedText>& texts, const std::string& table) {
    const Assignment given = assign_to_coordinates(texts, table, table + " of ", model.names, families,
                                                   Vocabulary::system, found.sources, expansion);
    std::vector<NodeId> by_coordinate(model.coordinates.size(), no_node);
    for (const Family& family : families)
      for (std::uint32_t m = 0; m < family.members.size(); ++m)
        if (const std::uint32_t entry = given.entry_of[family.first + m]; entry != no_entry)
          by_coordinate[family.first + m] = expansion.node(given.entries[entry].value, family.members[m]);
    return by_coordinate;
  };
  std::vector<NodeId> q = nodes(text.position, "position"), v = nodes(text.velocity, "velocity");
  NodeId t = no_node;
  if (text.t) {
    const Source& source = found.sources.add(*text.t, "t of the state");
    t = expansion.node(parse_expression(source, {&model.names, Vocabulary::system, {}}), {});
  }
  StateSubstitution substitution(model, text, tape, t, std::move(q), std::move(v), found.tape);
  found.t = substitution.instant();
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {
    found.q.push_back(substitution.position(i));
    found.v.push_back(substitution.velocity(i));
  }
  return found;
}

}  // namespace mechanics::expression
