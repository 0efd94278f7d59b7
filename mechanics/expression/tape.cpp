#include "mechanics/expression/tape.hpp"

#include <cmath>
#include <numbers>

namespace mechanics::expression {
namespace {

std::size_t hash(Operation operation, NodeId a, NodeId b) {
  std::uint64_t h =
      (std::uint64_t{a} << 32U | b) ^ (std::uint64_t{static_cast<std::uint8_t>(operation)} << 57U);
  h ^= h >> 32U;
  h *= 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio (Knuth 1973, 6.4)
  h ^= h >> 29U;
  h *= 0xBF58476D1CE4E5B9ULL;
  return static_cast<std::size_t>(h ^ h >> 32U);
}

}  // namespace

NodeId Tape::find_or_add(Operation operation, NodeId a, NodeId b, Origin origin, double value,
                         std::uint8_t depends) {
  const std::size_t mask = table_.size() - 1;
  std::size_t place = hash(operation, a, b) & mask;
  for (; table_[place] != no_node; place = (place + 1) & mask) {
    const NodeId node = table_[place];
    if (operation_[node] == operation && a_[node] == a && b_[node] == b) return node;
  }
  const auto node = static_cast<NodeId>(size());
  table_[place] = node;
  operation_.push_back(operation);
  a_.push_back(a);
  b_.push_back(b);
  value_.push_back(value);
  depends_.push_back(depends);
  origin_.push_back(origin);
  if (2 * size() > table_.size()) grow_table();
  return node;
}

void Tape::grow_table() {
  table_.assign(2 * table_.size(), no_node);
  const std::size_t mask = table_.size() - 1;
  for (NodeId node = 0; node < size(); ++node) {
    std::size_t place = hash(operation_[node], a_[node], b_[node]) & mask;
    while (table_[place] != no_node) place = (place + 1) & mask;
    table_[place] = node;
  }
}

std::uint32_t Tape::text_number(std::string_view text) {
  const auto [found, is_new] = text_numbers_.emplace(text, static_cast<std::uint32_t>(texts_.size()));
  if (is_new) texts_.emplace_back(text);
  return found->second;
}

const std::string& Tape::text(NodeId node) const {
  return texts_[operation_[node] == Operation::literal ? a_[node] : b_[node]];
}

NodeId Tape::literal(std::string_view text, double number, Origin origin) {
  const std::uint32_t n = text_number(text);
  return find_or_add(Operation::literal, n, n, origin, number, on_nothing);
}

NodeId Tape::pi(Origin origin) {
  return find_or_add(Operation::pi, 0, 0, origin, std::numbers::pi, on_nothing);
}

NodeId Tape::parameter(std::string_view name, NodeId meaning, Origin origin) {
  return find_or_add(Operation::parameter, meaning, text_number(name), origin, value_[meaning], on_nothing);
}

NodeId Tape::coordinate(std::uint32_t i, Origin origin) {
  return find_or_add(Operation::coordinate, i, i, origin, 0, on_coordinates);
}

NodeId Tape::velocity(std::uint32_t i, Origin origin) {
  return find_or_add(Operation::velocity, i, i, origin, 0, on_velocities);
}

NodeId Tape::time(Origin origin) { return find_or_add(Operation::time, 0, 0, origin, 0, on_time); }

bool Tape::chooses_among(Operation operation, NodeId chain, NodeId x) const {
  for (; operation_[chain] == operation; chain = a_[chain])
    if (a_[chain] == x || b_[chain] == x) return true;
  return chain == x;
}

NodeId Tape::apply(Operation operation, NodeId a, NodeId b, Origin origin) {
  if (operation == Operation::min || operation == Operation::max) {
    if (chooses_among(operation, a, b)) return a;
    if (chooses_among(operation, b, a)) return b;
  }
  const auto depends = static_cast<std::uint8_t>(depends_[a] | depends_[b]);
  has_branches_ = has_branches_ || is_branch(operation);
  double result = 0;
  if (depends == on_nothing)
    result = std::isfinite(value_[a]) && std::isfinite(value_[b]) ? value(operation, value_[a], value_[b])
                                                                  : std::numeric_limits<double>::quiet_NaN();
  return find_or_add(operation, a, b, origin, result, depends);
}

namespace {

constexpr std::size_t longest_written = 60;
constexpr int deepest_written = 12;

void write(const Tape& tape, NodeId node, const std::vector<std::string>& coordinates, int depth,
           std::string& out) {
  if (depth > deepest_written || out.size() > longest_written) {
    if (!out.ends_with("…")) out += "…";
    return;
  }
  const auto part = [&](NodeId operand) { write(tape, operand, coordinates, depth + 1, out); };
  const Operation operation = tape.operation(node);
  switch (operation) {
    case Operation::literal:
      out += tape.text(node).substr(0, tape.text(node).find(radius_mark));
      return;
    case Operation::parameter:
      out += tape.text(node);
      return;
    case Operation::coordinate:
      out += coordinates[tape.a(node)];
      return;
    case Operation::velocity:
      out += coordinates[tape.a(node)] + "'";
      return;
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::power:
      if (depth > 0) out += "(";
      part(tape.a(node));
      out += symbol(operation);
      part(tape.b(node));
      if (depth > 0) out += ")";
      return;
    case Operation::negate:
      out += depth > 0 ? "(-" : "-";
      part(tape.a(node));
      if (depth > 0) out += ")";
      return;
    default:
      break;
  }
  out += symbol(operation);
  if (arity(operation) == 0) return;
  out += "(";
  part(tape.a(node));
  if (is_where(operation)) out += operation == Operation::where_negative ? " < 0" : " >= 0";
  if (arity(operation) == 2) {
    out += ", ";
    part(tape.b(node));
  }
  out += ")";
}

}  // namespace

std::string written(const Tape& tape, NodeId node, const std::vector<std::string>& coordinates) {
  std::string out;
  write(tape, node, coordinates, 0, out);
  return out;
}

}  // namespace mechanics::expression
