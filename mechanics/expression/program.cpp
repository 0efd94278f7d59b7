#include "mechanics/expression/program.hpp"

#include <algorithm>

namespace mechanics::expression {
namespace {

constexpr Slot unplaced = no_node;

/// The nodes below some roots that are neither variables nor seen before, operands first; descends into no
/// constant.
class Reach {
 public:
  explicit Reach(const Tape& tape) : tape_(&tape), seen_(tape.size()) {}
  std::vector<NodeId> below(const std::vector<NodeId>& roots) {
    std::vector<NodeId> found, open = roots;
    while (!open.empty()) {
      const NodeId node = open.back();
      open.pop_back();
      if (seen_[node]) continue;
      seen_[node] = true;
      found.push_back(node);
      if (tape_->is_constant(node)) continue;
      const int operands = arity(tape_->operation(node));
      if (operands >= 1) open.push_back(tape_->a(node));
      if (operands == 2) open.push_back(tape_->b(node));
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  const Tape* tape_;
  std::vector<bool> seen_;
};

}  // namespace

Program::Program(const Tape& tape, std::size_t coordinates, const std::vector<std::vector<NodeId>>& groups)
    : n_(coordinates), node_(2 * coordinates + 1, no_node) {
  std::vector<Slot> slot(tape.size(), unplaced);
  std::vector<std::vector<NodeId>> computed;
  Reach reach(tape);
  for (const auto& roots : groups) {
    computed.emplace_back();
    for (const NodeId node : reach.below(roots)) {
      switch (tape.operation(node)) {
        case Operation::coordinate:
          node_[slot[node] = coordinate(tape.a(node))] = node;
          break;
        case Operation::velocity:
          node_[slot[node] = velocity(tape.a(node))] = node;
          break;
        case Operation::time:
          node_[slot[node] = time()] = node;
          break;
        default:
          if (!tape.is_constant(node)) {
            computed.back().push_back(node);
            break;
          }
          slot[node] = static_cast<Slot>(node_.size());
          node_.push_back(node);
          constants_.push_back(tape.constant(node));
      }
    }
    constant_ends_.push_back(constants_.size());
  }
  first_ = static_cast<Slot>(node_.size());
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (const NodeId node : computed[group]) {
      const NodeId a = tape.a(node), b = tape.b(node);
      slot[node] = static_cast<Slot>(node_.size());
      node_.push_back(node);
      has_branches_ = has_branches_ || is_where(tape.operation(node));
      code_.push_back({tape.operation(node), {!tape.is_constant(a), !tape.is_constant(b)}, slot[a], slot[b]});
    }
    ends_.push_back(static_cast<Slot>(node_.size()));
    roots_.emplace_back();
    for (const NodeId root : groups[group]) roots_.back().push_back(slot[root]);
  }
  if (has_branches_) find_differentiated();
}

void Program::find_differentiated() {
  is_differentiated_.assign(size(), false);
  for (const auto& roots : roots_)
    for (const Slot root : roots) is_differentiated_[root] = true;
  for (Slot slot = static_cast<Slot>(size()); slot-- > first_;) {
    if (!is_differentiated_[slot]) continue;
    const Instruction& i = (*this)[slot];
    is_differentiated_[i.b] = true;
    if (!is_where(i.operation)) is_differentiated_[i.a] = true;
  }
}

Values Program::values(const State& state, std::size_t group, bool& is_finite) const {
  Values x(size());
  std::copy(state.q.begin(), state.q.end(), x.begin());
  std::copy(state.v.begin(), state.v.end(), x.begin() + static_cast<std::ptrdiff_t>(n_));
  x[time()] = state.t;
  std::copy(constants_.begin(), constants_.end(), x.begin() + time() + 1);
  double spoiled = 0;  // 0 times a number, unless it is not finite
  for (std::size_t k = 0; k < constant_ends_[group]; ++k) spoiled += 0 * constants_[k];
  for (Slot slot = first_; slot < ends_[group]; ++slot) {
    const Instruction& i = code_[slot - first_];
    x[slot] = value(i.operation, x[i.a], x[i.b]);
    spoiled += 0 * x[slot];
  }
  is_finite = spoiled == 0;
  if (!has_branches_) return x;
  const std::vector<bool> used = in_use(x, group);
  is_finite = true;
  for (Slot slot = 0; slot < ends_[group]; ++slot)
    is_finite = is_finite && (!used[slot] || std::isfinite(x[slot]));
  strike_unused(x, group, used);
  return x;
}

template <class Real>
std::vector<bool> Program::in_use(const ValuesOf<Real>& x, std::size_t group) const {
  std::vector<bool> used(size());
  for (std::size_t g = 0; g <= group; ++g)
    for (const Slot root : roots_[g]) used[root] = true;
  for (Slot slot = ends_[group]; slot-- > first_;) {
    if (!used[slot]) continue;
    const Instruction& i = code_[slot - first_];
    used[i.a] = true;
    if (!is_where(i.operation) || (x[i.a] < 0) == (i.operation == Operation::where_negative))
      used[i.b] = true;
  }
  return used;
}

template <class Real>
void Program::strike_unused(ValuesOf<Real>& x, std::size_t group, const std::vector<bool>& used) const {
  for (Slot slot = first_; slot < ends_[group]; ++slot)
    if (!used[slot]) x[slot] = std::numeric_limits<double>::quiet_NaN();
}

template std::vector<bool> Program::in_use(const Values&, std::size_t) const;
template std::vector<bool> Program::in_use(const ValuesOf<Rounded>&, std::size_t) const;

namespace {

void take_what_is_known(const std::vector<KnownNode>& known, NodeId node, Rounded& x) {
  const auto at = std::lower_bound(known.begin(), known.end(), node,
                                   [](const KnownNode& k, NodeId wanted) { return k.node < wanted; });
  if (at == known.end() || at->node != node) return;
  if (!at->number.is_undecided())
    x = at->number;
  else
    x.radius = std::min(x.radius, widened(std::abs(x.value - at->number.value) + at->number.radius));
}

}  // namespace

ValuesOf<Rounded> Program::rounded_values(const RoundedState& state, std::size_t group,
                                          const std::vector<Rounded>& of_nodes) const {
  ValuesOf<Rounded> x(size());
  std::copy(state.q.begin(), state.q.end(), x.begin());
  std::copy(state.v.begin(), state.v.end(), x.begin() + static_cast<std::ptrdiff_t>(n_));
  x[time()] = state.t;
  for (Slot slot = time() + 1; slot < first_; ++slot) x[slot] = of_nodes[node_[slot]];
  for (Slot slot = first_; slot < ends_[group]; ++slot) {
    const Instruction& i = code_[slot - first_];
    x[slot] = value(i.operation, x[i.a], x[i.b]);
    if (!state.known.empty()) take_what_is_known(state.known, node_[slot], x[slot]);
  }
  if (has_branches_) strike_unused(x, group, in_use(x, group));
  return x;
}

}  // namespace mechanics::expression
