#include "mechanics/expression/constraint_series.hpp"

#include <algorithm>
#include <unordered_map>

#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics::expression {
namespace {

/// The constants of a tape with the rounding that made them.
class Constants {
 public:
  explicit Constants(const Tape& tape) : tape_(&tape) {}

  Rounded of(NodeId root) {
    std::vector<NodeId> open{root};
    while (!open.empty()) {
      const NodeId node = open.back();
      const std::size_t before = open.size();
      const int operands = arity(tape_->operation(node));
      const bool stands_for = tape_->operation(node) == Operation::parameter;
      if ((operands >= 1 || stands_for) && known_.count(tape_->a(node)) == 0) open.push_back(tape_->a(node));
      if (operands == 2 && known_.count(tape_->b(node)) == 0) open.push_back(tape_->b(node));
      if (open.size() > before) continue;
      open.pop_back();
      known_.emplace(node, made(node));
    }
    return known_.at(root);
  }

 private:
  Rounded made(NodeId node) const {
    const double value = tape_->constant(node);
    const Operation operation = tape_->operation(node);
    constexpr double rounding = 0x1p-53;
    if (operation == Operation::literal) return rounded_literal(*tape_, node);
    if (operation == Operation::pi) return {value, value * rounding};
    const TimeSeries a(known_.at(tape_->a(node)));
    if (operation == Operation::parameter) return a.c[0];
    const TimeSeries b(arity(operation) == 2 ? known_.at(tape_->b(node)) : Rounded());
    return applied(operation, a, b, true, 0).c[0];
  }

  const Tape* tape_;
  std::unordered_map<NodeId, Rounded> known_;
};

}  // namespace

ConstraintSeries::ConstraintSeries(const LagrangianModel& model, const std::vector<Index>& constraints)
    : program_(&model.contacts) {
  const Program& program = model.contacts;
  std::vector<Slot> open;
  std::vector<bool> seen(program.size());
  const auto visit = [&](Slot slot) {
    if (seen[slot]) return;
    seen[slot] = true;
    open.push_back(slot);
  };
  for (const Index a : constraints) {
    roots_.push_back(program.roots(0)[static_cast<std::size_t>(a)]);
    visit(roots_.back());
  }
  Constants constants(model.tape);
  while (!open.empty()) {
    const Slot slot = open.back();
    open.pop_back();
    if (program.is_computed(slot)) {
      order_.push_back(slot);
      visit(program[slot].a);
      visit(program[slot].b);
    } else if (program.is_constant(slot)) {
      constants_.emplace_back(slot, constants.of(program.node(slot)));
    } else if (slot != program.time()) {
      coordinates_.push_back(static_cast<Index>(slot));
    }
  }
  std::sort(order_.begin(), order_.end());
  std::sort(coordinates_.begin(), coordinates_.end());
}

std::vector<TimeSeries> ConstraintSeries::along(const std::vector<TimeSeries>& q, const TimeSeries& t,
                                                int order, Instant instant) const {
  const Program& program = *program_;
  std::vector<TimeSeries> x(program.size());
  for (const Index i : coordinates_) x[static_cast<std::size_t>(i)] = q[static_cast<std::size_t>(i)];
  x[program.time()] = t;
  for (const auto& [slot, constant] : constants_) x[slot] = TimeSeries(constant);
  for (const Slot slot : order_) {
    const auto& i = program[slot];
    x[slot] = applied(i.operation, x[i.a], x[i.b], !i.active.b, order, instant);
  }
  std::vector<TimeSeries> found;
  for (const Slot root : roots_) found.push_back(x[root]);
  return found;
}

std::vector<std::vector<Index>> coordinates_of(const Program& program,
                                               const std::vector<Index>& constraints) {
  std::vector<std::size_t> seen(program.size());
  std::vector<std::vector<Index>> found;
  for (const Index a : constraints) {
    std::vector<Index>& coordinates = found.emplace_back();
    std::vector<Slot> open{program.roots(0)[static_cast<std::size_t>(a)]};
    while (!open.empty()) {
      const Slot slot = open.back();
      open.pop_back();
      if (seen[slot] == found.size()) continue;
      seen[slot] = found.size();
      if (slot < program.coordinates()) coordinates.push_back(static_cast<Index>(slot));
      if (!program.is_computed(slot)) continue;
      open.push_back(program[slot].a);
      open.push_back(program[slot].b);
    }
  }
  return found;
}

}  // namespace mechanics::expression
