#pragma once

#include <span>
#include <utility>
#include <vector>

#include "mechanics/expression/program.hpp"

namespace mechanics::expression {

// For doubles, and for doubles with radii (`Rounded`), by one text: the radii are those of these very sweeps.

/// First partials of the operations of group 0, from program.begin() on.
template <class Real>
std::vector<PartialsOf<Real>> first_partials(const Program& program, const ValuesOf<Real>& x);

/// Forward: the rates of all slots of group 0 when q moves at the rates `v`, velocities at `v2` (they rest
/// when it is empty) and t at the rate 1.
template <class Real>
ValuesOf<Real> tangents(const Program& program, const std::vector<PartialsOf<Real>>& p,
                        std::span<const Real> v, std::span<const Real> v2 = {});

/// Reverse: the derivatives of a weighted sum of slots of group 0 by every slot; those by constants mean
/// nothing.
template <class Real>
ValuesOf<Real> adjoints(const Program& program, const std::vector<PartialsOf<Real>>& p,
                        const std::vector<std::pair<Slot, double>>& weights);

/// First and second time derivatives of the slots of group 0 along a motion with velocity v and acceleration
/// q2.
template <class Real>
struct RatesOf {
  ValuesOf<Real> first, second;
};
/// `second` is empty when `q2` is null. `wanted`: the slots that are asked for, all if null.
template <class Real>
RatesOf<Real> rates(const Program& program, const ValuesOf<Real>& x, std::span<const Real> v,
                    const Vector* q2, const std::vector<bool>* wanted = nullptr);

/// Gradients of single slots, each by a reverse sweep over what lies below it and nothing else.
template <class Real>
class GradientsOf {
 public:
  explicit GradientsOf(const Program& program)
      : program_(&program), adjoint_(program.size()), seen_(program.size()) {}
  /// ∂slot/∂q_i in increasing order of i, structural zeros left out, and ∂slot/∂t.
  struct Gradient {
    std::vector<std::pair<Index, Real>> by_q;
    Real by_t = 0;
  };
  const Gradient& of(Slot slot, const ValuesOf<Real>& x);
  /// The operations below a slot, operands first.
  const std::vector<Slot>& below(Slot slot);
  const std::vector<Slot>& last_below() const { return order_; }

 private:
  const Program* program_;
  ValuesOf<Real> adjoint_;
  std::vector<std::uint32_t> seen_;  // by slot: the last request that reached it
  std::uint32_t request_ = 0;
  std::vector<Slot> order_, variables_, open_;
  Gradient gradient_;
};
using Gradients = GradientsOf<double>;

}  // namespace mechanics::expression
