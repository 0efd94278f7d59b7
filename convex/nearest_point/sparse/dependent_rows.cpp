#include "convex/nearest_point/sparse/dependent_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "convex/exact/modular.hpp"
#include "convex/linear_algebra/elimination_order.hpp"

namespace convex::inline sparse {
namespace {

using Residue = ModularField::Word;

/// Longer rows come last and do not decide the order: they fill what they are eliminated from.
constexpr std::size_t long_row = 32;

struct Term {
  int column;  ///< in the order of elimination; past the last coordinate: the bound
  Residue value;
};

/// Doubles modulo a prime: m 2^e is m times a power of 2, which is no multiple of it.
class Residues {
 public:
  explicit Residues(const ModularField& field) : field_(field) {
    powers_.resize(2 * widest + 1);
    powers_[widest] = field.one();
    const Residue two = field.from_word(2), half = field.inverse(two);
    for (std::size_t e = 1; e <= widest; ++e) {
      powers_[widest + e] = field.times(powers_[widest + e - 1], two);
      powers_[widest - e] = field.times(powers_[widest - e + 1], half);
    }
  }
  Residue of(double x) const {
    constexpr int mantissa_bits = 53;
    int exponent = 0;
    const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), mantissa_bits));
    const Residue size = field_.times(field_.from_word(static_cast<Residue>(digits < 0 ? -digits : digits)),
                                      powers_[at(static_cast<int>(widest) + exponent - mantissa_bits)]);
    return digits < 0 ? field_.minus(0, size) : size;
  }

 private:
  static constexpr std::size_t widest = 1200;  // exponents of doubles, digits included
  const ModularField& field_;
  std::vector<Residue> powers_;
};

class RowEchelon {
 public:
  RowEchelon(const ConstraintRows& U, const Vector& s, const std::vector<Index>& rows, std::uint64_t prime,
             double most)
      : U_(U), s_(s), field_(prime), residues_(field_), most_(most) {
    find_order(rows);
    const auto n = at(U.dimension());
    pivot_row_.resize(n);
    values_.assign(n + 1, 0);
    present_.assign(n + 1, false);
  }

  enum class Kind { independent, implied, contradicting };
  /// What is left of a row; with `take` an independent one joins the echelon.
  Kind put(Index a, bool take) {
    const auto n = static_cast<int>(U_.dimension());
    U_.for_each_entry(a, [&](Index i, double u) { set(place_[at(i)], residues_.of(u)); });
    set(n, residues_.of(s_[a]));
    std::vector<Term> left;
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const int column = heap_.back();
      heap_.pop_back();
      present_[at(column)] = false;
      const Residue value = values_[at(column)];
      if (value == 0) continue;
      if (!left.empty() || column == n || pivot_row_[at(column)].empty())
        left.push_back({column, value});  // what comes after the first is reduced when it has to be
      else
        subtract(pivot_row_[at(column)], value);
    }
    if (left.empty()) return Kind::implied;
    if (left.front().column == n) return Kind::contradicting;
    if (take) {
      const Residue inverse = field_.inverse(left.front().value);
      for (Term& term : left) term.value = field_.times(term.value, inverse);
      pivot_row_[at(left.front().column)] = std::move(left);
    }
    return Kind::independent;
  }
  bool is_too_long() const { return work_ > most_; }

 private:
  void find_order(const std::vector<Index>& rows) {
    std::vector<std::pair<int, int>> edges;
    std::vector<int> columns;
    for (Index a : rows) {
      columns.clear();
      U_.for_each_entry(a, [&](Index i, double) { columns.push_back(static_cast<int>(i)); });
      if (columns.size() > long_row) continue;
      for (std::size_t k = 0; k < columns.size(); ++k)
        for (std::size_t l = 0; l < k; ++l) edges.emplace_back(columns[l], columns[k]);
    }
    const linear_algebra::Neighbours graph(U_.dimension(), static_cast<Index>(edges.size()),
                                           [&](Index k) { return edges[at(k)]; });
    place_ = elimination_order(graph).new_place;
  }
  void set(int column, Residue value) {
    values_[at(column)] = value;
    meet(column);
  }
  void meet(int column) {
    if (present_[at(column)]) return;
    present_[at(column)] = true;
    heap_.push_back(column);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }
  void subtract(const std::vector<Term>& pivot, Residue factor) {
    work_ += static_cast<double>(pivot.size());
    for (std::size_t k = 1; k < pivot.size(); ++k) {
      Residue& value = values_[at(pivot[k].column)];
      if (!present_[at(pivot[k].column)]) value = 0;
      value = field_.minus(value, field_.times(factor, pivot[k].value));
      meet(pivot[k].column);
    }
  }

  const ConstraintRows& U_;
  const Vector& s_;
  ModularField field_;
  Residues residues_;
  double most_, work_ = 0;
  std::vector<int> place_;
  std::vector<std::vector<Term>> pivot_row_;  ///< by its first column, 1 there
  std::vector<Residue> values_;
  std::vector<bool> present_;
  std::vector<int> heap_;
};

Index length_of(const ConstraintRows& U, Index a) {
  return U.is_sparse() ? U.sparse().outerIndexPtr()[a + 1] - U.sparse().outerIndexPtr()[a] : U.dimension();
}

std::optional<RowDependences> dependences_modulo(std::uint64_t prime, const ConstraintRows& U,
                                                 const Vector& s, const std::vector<Index>& held,
                                                 const std::vector<Index>& degenerate, double most) {
  const auto by_length = [&](std::vector<Index> rows) {
    std::stable_sort(rows.begin(), rows.end(),
                     [&](Index a, Index b) { return length_of(U, a) < length_of(U, b); });
    return rows;
  };
  std::vector<Index> all = held;
  all.insert(all.end(), degenerate.begin(), degenerate.end());
  RowEchelon echelon(U, s, all, prime, most);
  RowDependences found;
  for (Index a : by_length(held)) {
    const RowEchelon::Kind kind = echelon.put(a, true);
    if (kind == RowEchelon::Kind::independent) found.independent.push_back(a);
    if (kind == RowEchelon::Kind::contradicting) found.consistent = false;
    if (echelon.is_too_long()) return std::nullopt;
  }
  std::vector<Index> besides;
  for (Index a : degenerate) {
    const RowEchelon::Kind kind = echelon.put(a, false);
    if (kind == RowEchelon::Kind::independent) besides.push_back(a);
    if (kind == RowEchelon::Kind::implied) found.implied.push_back(a);
    if (kind == RowEchelon::Kind::contradicting) found.off_edge.push_back(a);
    if (echelon.is_too_long()) return std::nullopt;
  }
  for (Index a : by_length(besides)) {
    if (echelon.put(a, true) == RowEchelon::Kind::independent) found.independent.push_back(a);
    if (echelon.is_too_long()) return std::nullopt;
  }
  std::sort(found.independent.begin(), found.independent.end());
  return found;
}

}  // namespace

std::optional<RowDependences> row_dependences(const ConstraintRows& U, const Vector& s,
                                              const std::vector<Index>& held,
                                              const std::vector<Index>& degenerate, double most) {
  const auto first = dependences_modulo(large_primes.at(0), U, s, held, degenerate, most);
  if (!first || first->independent.size() == held.size() + degenerate.size()) return first;  // proved
  const auto second = dependences_modulo(large_primes.at(1), U, s, held, degenerate, most);
  return second && *second == *first ? first : std::nullopt;
}

}  // namespace convex::inline sparse
