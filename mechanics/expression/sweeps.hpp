#pragma once

#include <utility>
#include <vector>

#include "mechanics/expression/program.hpp"

namespace mechanics::expression {

/// First partials of the operations of group 0, from program.begin() on.
std::vector<Partials> first_partials(const Program& program, const Values& x);

/// Forward: the rates of all slots of group 0 when q moves at the rate `v` and t at the rate 1; velocities
/// rest.
Values tangents(const Program& program, const std::vector<Partials>& p, const Vector& v);

/// Reverse: the derivatives of a weighted sum of slots of group 0 by every slot; those by constants mean
/// nothing.
Values adjoints(const Program& program, const std::vector<Partials>& p,
                const std::vector<std::pair<Slot, double>>& weights);

/// First and second time derivatives of the slots of group 0 along a motion with velocity v and acceleration
/// q2.
struct Rates {
  Values first, second;
};
/// `second` is empty when `q2` is null. `wanted`: the slots that are asked for, all if null.
Rates rates(const Program& program, const Values& x, const Vector& v, const Vector* q2,
            const std::vector<bool>* wanted = nullptr);

/// Gradients of single slots, each by a reverse sweep over what lies below it and nothing else.
class Gradients {
 public:
  explicit Gradients(const Program& program)
      : program_(&program), adjoint_(program.size()), seen_(program.size()) {}
  /// ∂slot/∂q_i in increasing order of i, structural zeros left out, and ∂slot/∂t.
  struct Gradient {
    std::vector<std::pair<Index, double>> by_q;
    double by_t = 0;
  };
  const Gradient& of(Slot slot, const Values& x);
  /// The operations below a slot, operands first.
  const std::vector<Slot>& below(Slot slot);
  const std::vector<Slot>& last_below() const { return order_; }

 private:
  const Program* program_;
  Values adjoint_;
  std::vector<std::uint32_t> seen_;  // by slot: the last request that reached it
  std::uint32_t request_ = 0;
  std::vector<Slot> order_, variables_, open_;
  Gradient gradient_;
};

}  // namespace mechanics::expression
