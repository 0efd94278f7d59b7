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
  /// d/dε ∂T/∂v when the slots move at the rates `tangent`.
  Vector gradient_rate(const Program& program, const Values& x, const Values& adjoint,
                       const Values& tangent) const;
  std::size_t colours() const { return colouring_.seeds.size(); }

 private:
  struct Term {   // an operation that depends on velocities
    Slot slot;    // in the program
    Slot a, b;    // the operands that depend on them, numbered as `place`; 0 for none
    bool second;  // if only one does: whether it is the second operand
  };
  struct Coefficients {
    double a, b, mixed;  // partials, and what one operand's tangent adds to the other's adjoint
  };
  struct Entry {
    std::uint32_t row, at, mirror;  // of a sweep's result, where it goes in the matrix
  };
  std::vector<Coefficients> coefficients(const Program& program, const Values& x,
                                         const Values& adjoint) const;
  void find_pattern(const Program& program, const Degrees& degrees);
  void lay_out(const Pattern& pattern);
  /// Several tangents, or adjoints' tangents, at once, by place; place 0 stands for an operand that does not
  /// vary.
  template <int lanes>
  using Bundle =
      std::vector<Eigen::Array<double, lanes, 1>, Eigen::aligned_allocator<Eigen::Array<double, lanes, 1>>>;
  template <int lanes>
  void sweep(const std::vector<Coefficients>& c, std::size_t colour, Bundle<lanes>& tangent,
             Bundle<lanes>& rate, std::vector<double>& values) const;

  std::size_t n_ = 0;
  std::vector<Term> terms_;  // term k has the place n + 1 + k; velocity i has 1 + i
  Colouring colouring_;
  std::vector<std::vector<Entry>> entries_;  // by colour
  std::vector<int> outer_, inner_;           // of the compressed matrix
};

}  // namespace mechanics::expression
