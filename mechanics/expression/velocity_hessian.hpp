#pragma once

#include <vector>

#include "convex/vector.hpp"
#include "mechanics/expression/degree.hpp"
#include "mechanics/expression/program.hpp"
#include "mechanics/expression/sparsity.hpp"

namespace mechanics::expression {

/// Second derivatives of T, a polynomial of degree at most 2 in the velocities, by forward-over-reverse
/// sweeps over those of its operations that depend on velocities: sums, products, quotients by and squares,
/// nothing else.
class VelocityHessian {
 public:
  VelocityHessian() = default;
  /// T is root 0 of group 0.
  VelocityHessian(const Tape& tape, const Program& program, const Degrees& degrees);

  /// ∂²T/∂v∂v, exactly symmetric: four columns, or sets of columns that share no row, at a time.
  /// `adjoint`: ∂T by slot, the result of a reverse sweep.
  convex::SparseMatrix matrix(const Program& program, const Values& x, const Values& adjoint) const;
  /// The radii of its entries.
  convex::SparseMatrix matrix_radii(const Program& program, const ValuesOf<Rounded>& x,
                                    const ValuesOf<Rounded>& adjoint) const;
  /// d/dε ∂T/∂v when the slots move at the rates `tangent`.
  template <class Real>
  std::vector<Real> gradient_rate(const Program& program, const ValuesOf<Real>& x,
                                  const ValuesOf<Real>& adjoint, const ValuesOf<Real>& tangent) const;
  std::size_t colours() const { return colouring_.seeds.size(); }

 private:
  struct Term {   // an operation that depends on velocities
    Slot slot;    // in the program
    Slot a, b;    // the operands that depend on them, numbered as `place`; 0 for none
    bool second;  // if only one does: whether it is the second operand
  };
  template <class Real>
  struct Coefficients {
    Real a, b, mixed;  // partials, and what one operand's tangent adds to the other's adjoint
  };
  struct Entry {
    std::uint32_t row, at, mirror;  // of a sweep's result, where it goes in the matrix
  };
  template <class Real>
  std::vector<Coefficients<Real>> coefficients(const Program& program, const ValuesOf<Real>& x,
                                               const ValuesOf<Real>& adjoint) const;
  void find_pattern(const Program& program, const Degrees& degrees);
  void lay_out(const Pattern& pattern);
  /// A sweep over the terms: `tangent` is filled in from that of the velocities on, then `rate` from 0. By
  /// place; place 0 stands for an operand that does not vary. Lanes: one number, or several at once.
  template <class Lanes>
  using Bundle = std::vector<Lanes, Eigen::aligned_allocator<Lanes>>;
  template <class Lanes, class Real>
  void sweep(const std::vector<Coefficients<Real>>& c, Bundle<Lanes>& tangent, Bundle<Lanes>& rate) const;
  /// All columns by colours, so many lanes at once.
  template <int lanes, class Lanes, class Real>
  std::vector<Real> entries(const std::vector<Coefficients<Real>>& c) const;
  convex::SparseMatrix with_entries(const std::vector<double>& values) const;

  std::size_t n_ = 0;
  std::vector<Term> terms_;  // term k has the place n + 1 + k; velocity i has 1 + i
  Colouring colouring_;
  std::vector<std::vector<Entry>> entries_;  // by colour
  std::vector<int> outer_, inner_;           // of the compressed matrix
};

}  // namespace mechanics::expression
