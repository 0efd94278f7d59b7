#pragma once

#include <array>
#include <compare>
#include <map>
#include <optional>
#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::liquid {

/// An expression as a polynomial in the coordinates and in functions of them: what a text says of symmetry.
/// Sums, products and whole powers are multiplied out; any other operation is a function of its operands, of
/// which no more is known than that; a choice by a sign is the product of a function of that number and what
/// is chosen. Equal nodes of a tape are one node, so forms of one tape can be added.
class CoordinateForm {
 public:
  CoordinateForm(const expression::Tape&, expression::NodeId, std::size_t dimension);

  /// Whether it depends on the distance from the centre alone: each operand of each function does, and so
  /// does the polynomial P before each product of functions, (x_i - c_i) ∂P/∂x_j = (x_j - c_j) ∂P/∂x_i as
  /// polynomials, coefficients equal to their rounding. False where it is not seen.
  bool is_radial(const std::array<double, 3>& centre) const;
  /// Whether Σ F_i (x_i - c_i) does; none of them is null.
  static bool is_radial_along(const std::vector<const CoordinateForm*>& F,
                              const std::array<double, 3>& centre);
  /// The point where the gradient of the polynomial's squares and linear terms is 0; none without squares.
  std::optional<std::array<double, 3>> middle() const;

 private:
  enum class Kind : std::uint8_t { value, inverse, not_negative, negative };
  struct Symbol {
    Kind kind;
    expression::NodeId node;
    auto operator<=>(const Symbol&) const = default;
  };
  struct Monomial {
    std::array<int, 3> powers{};
    std::vector<Symbol> symbols;  ///< in order
    auto operator<=>(const Monomial&) const = default;
  };
  /// A coefficient, and the sum of the sizes of what it is the sum of.
  struct Amount {
    double value = 0, size = 0;
  };
  using Polynomial = std::map<Monomial, Amount>;

  class Reading;
  static void add(Polynomial& to, const Monomial&, Amount);
  static Polynomial product(const Polynomial&, const Polynomial&);
  static bool is_zero(const Polynomial&);
  bool is_radial(const Polynomial&, const std::array<double, 3>& centre) const;

  std::size_t dimension_;
  bool is_known_ = true;  ///< false: too long
  Polynomial polynomial_;
  std::map<Symbol, std::vector<Polynomial>> operands_;
};

}  // namespace mechanics::liquid
