#pragma once

#include <map>
#include <utility>
#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

using convex::Fraction;

/// Powers of atoms, exponents not 0, by the number of the atom.
using Powers = std::vector<std::pair<std::size_t, int>>;

/// Σ factor · product of powers, no factor 0; empty for 0. Equal products are one term.
using CollectedSum = std::map<Powers, Fraction>;

/// What a collected sum is made of: a variable, a parameter, pi or what is no number (`leaf`), a function of
/// sums, or a sum that stays together in a power or in a long product (`Operation::add`, its one argument).
struct CollectedAtom {
  Operation operation = Operation::literal;
  NodeId leaf = no_node;
  std::vector<CollectedSum> arguments;
};

bool operator<(const CollectedAtom&, const CollectedAtom&);

/// Expressions as a reader would write them: products multiplied out while they stay short, like terms
/// together, factors cancelled, sin² + cos² = 1 and the sums of angles used where fewer terms are left.
/// Equal to the expression wherever no factor that is cancelled is 0.
class Collection {
 public:
  explicit Collection(const Tape& tape) : tape_(tape) {}

  CollectedSum operator()(NodeId root) { return with_joined_angles(with_squares_joined(expanded(root))); }
  const CollectedAtom& atom(std::size_t number) const { return atoms_[number]; }

 private:
  const CollectedSum& expanded(NodeId node);
  CollectedSum made(NodeId node);
  CollectedSum of_atom(CollectedAtom atom, int exponent = 1);
  std::size_t number_of(CollectedAtom atom);
  CollectedSum product(CollectedSum a, CollectedSum b);
  CollectedSum power(const CollectedSum& base, int exponent);
  CollectedSum power(NodeId node);
  CollectedSum kept_together(const CollectedSum& a, int exponent);
  CollectedSum with_squares_joined(CollectedSum sum);
  CollectedSum without_square(const CollectedSum& sum, std::size_t squared, std::size_t other);
  CollectedSum with_joined_angles(CollectedSum sum);
  bool join_angles(CollectedSum& sum);
  /// The function of angle a ± b, and its sign.
  std::pair<std::size_t, int> of_angles(Operation function, std::size_t a, std::size_t b, int sign_of_b);

  const Tape& tape_;
  std::vector<CollectedAtom> atoms_;
  std::map<CollectedAtom, std::size_t> numbers_;
  std::map<NodeId, CollectedSum> known_;
};

}  // namespace mechanics::expression
