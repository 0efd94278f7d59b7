#pragma once

#include <span>
#include <vector>

#include "mechanics/expression/rounded.hpp"
#include "mechanics/expression/tape.hpp"
#include "mechanics/state.hpp"

namespace mechanics::expression {

using Slot = std::uint32_t;
using Values = std::vector<double>;  // by slot
template <class Real>
using ValuesOf = std::vector<Real>;

/// The mark of an operation that no branch taken uses.
inline bool is_unused(double x) { return std::isnan(x); }
inline bool is_unused(Rounded x) { return std::isnan(x.value); }

/// What is known of a node's number otherwise than by its evaluation.
struct KnownNode {
  NodeId node;
  Rounded number;
};

/// A state with a radius to each number, and what is known of nodes at it, in their order.
struct RoundedState {
  Rounded t;
  std::vector<Rounded> q, v;
  /// Those whose sign is told are taken as they are, not as they are evaluated: then values are those of the
  /// branches as written, and others than doubles have.
  std::vector<KnownNode> known = {};
};

/// The part of a tape that some roots need, ready to be run. Slots: q (n of them), v (n), t, the constants,
/// and then one for each operation, after its operands.
class Program {
 public:
  struct Instruction {
    Operation operation;
    Active active;  ///< which operands are no constants
    Slot a, b;
  };

  Program() = default;
  /// The operations of the first group of roots come first, then what the next group needs in addition, …
  Program(const Tape& tape, std::size_t coordinates, const std::vector<std::vector<NodeId>>& groups);

  Slot coordinate(std::size_t i) const { return static_cast<Slot>(i); }
  Slot velocity(std::size_t i) const { return static_cast<Slot>(n_ + i); }
  Slot time() const { return static_cast<Slot>(2 * n_); }
  std::size_t coordinates() const { return n_; }
  std::size_t size() const { return node_.size(); }
  std::size_t groups() const { return ends_.size(); }
  /// The first slot of an operation, and the one after the last operation of a group.
  Slot begin() const { return first_; }
  Slot end(std::size_t group) const { return ends_[group]; }
  const Instruction& operator[](Slot slot) const { return code_[slot - first_]; }
  /// The slots of a group's roots, in the order they were given.
  const std::vector<Slot>& roots(std::size_t group) const { return roots_[group]; }
  NodeId node(Slot slot) const { return node_[slot]; }

  /// The values up to the end of a group, at a state; `is_finite` tells whether all of them are. An operation
  /// that is used by branches alone that are not taken has the value NaN and the partials 0;
  /// one that conditions alone use has the partials 0.
  Values values(const State& state, std::size_t group, bool& is_finite) const;
  /// The same doubles with radii. `of_nodes`: the constants of the tape, by node.
  ValuesOf<Rounded> rounded_values(const RoundedState& state, std::size_t group,
                                   const std::vector<Rounded>& of_nodes) const;
  /// By slot: whether something of the groups up to this one uses it, on the branches that the values take.
  template <class Real>
  std::vector<bool> in_use(const ValuesOf<Real>& x, std::size_t group) const;
  template <class Real>
  PartialsOf<Real> partials(Slot slot, const ValuesOf<Real>& x) const {
    if (has_branches_ && (!is_differentiated_[slot] || is_unused(x[slot]))) return {};
    const Instruction& i = (*this)[slot];
    return expression::partials(i.operation, x[i.a], x[i.b], x[slot], i.active);
  }
  template <class Real>
  SecondPartialsOf<Real> second_partials(Slot slot, const ValuesOf<Real>& x) const {
    if (has_branches_ && (!is_differentiated_[slot] || is_unused(x[slot]))) return {};
    const Instruction& i = (*this)[slot];
    return expression::second_partials(i.operation, x[i.a], x[i.b], x[slot], i.active);
  }
  bool is_computed(Slot slot) const { return slot >= first_; }
  bool is_constant(Slot slot) const { return slot > time() && slot < first_; }
  bool has_branches() const { return has_branches_; }

 private:
  void find_differentiated();
  template <class Real>
  void strike_unused(ValuesOf<Real>& x, std::size_t group, const std::vector<bool>& used) const;
  std::size_t n_ = 0;
  Slot first_ = 0;
  std::vector<Instruction> code_;
  std::vector<Slot> ends_;                  // by group, of the operations
  std::vector<std::size_t> constant_ends_;  // by group, in constants_
  std::vector<std::vector<Slot>> roots_;
  std::vector<NodeId> node_;  // by slot; no_node for a variable that is not used
  Values constants_;
  bool has_branches_ = false;
  std::vector<bool> is_differentiated_;  // with branches: what more than conditions depends on
};

}  // namespace mechanics::expression
