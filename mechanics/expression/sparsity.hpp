#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace mechanics::expression {

/// The nonzeros of a symmetric matrix: by row, the columns in increasing order; the diagonal always belongs
/// to it.
using Pattern = std::vector<std::vector<std::uint32_t>>;

/// Collects the products of sums whose second derivatives fill a matrix: variables of one factor meet those
/// of the other. Equal sets are stored once, so that a chain in which each product has all variables so far
/// is cheap.
class Sparsity {
 public:
  using Set = std::uint32_t;
  explicit Sparsity(std::uint32_t variables) : variables_(variables) {}
  /// The set with this number is {variable}.
  Set single(std::uint32_t variable) const { return variable; }
  /// The set of these variables, in any order and repeated at will.
  Set set(std::vector<std::uint32_t> variables);
  const std::vector<std::uint32_t>& variables(Set set) const { return sets_[set - variables_]; }
  void append(Set set, std::vector<std::uint32_t>& to) const;
  void product(Set x, Set y);
  Pattern pattern() const;

 private:
  void add_cliques(Pattern& rows) const;
  std::uint32_t variables_;
  std::vector<std::vector<std::uint32_t>> sets_;  // those of two and more
  std::unordered_multimap<std::uint64_t, Set> by_hash_;
  std::unordered_set<std::uint64_t> products_;  // pairs (smaller, larger)
};

/// Which columns are found in one sweep, and where each entry is read off: `seeds[c]` are the columns of
/// colour c. Entry (row, column) of the lower triangle is entry `row` of the sweep of colour c = `colour`,
/// when no other column of the colour has a nonzero in that row. A column that meets too many others is alone
/// in its colour, and gives its row too, by symmetry.
struct Colouring {
  std::vector<std::vector<std::uint32_t>> seeds;
  std::vector<std::uint32_t> colour;  ///< by column
  std::vector<bool> alone;            ///< by column
};
Colouring colouring(const Pattern& pattern);

}  // namespace mechanics::expression
