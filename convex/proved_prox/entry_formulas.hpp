#pragma once

#include <memory>

#include "convex/proved_prox/ball_numbers.hpp"

namespace convex::inline proved_prox {

/// A function of one entry with its conjugate, in balls: what the separable functions of the catalogue that
/// are no polynomials by pieces are made of. None stands for +inf, and for what balls cannot tell.
class EntryFormula {
 public:
  virtual ~EntryFormula() = default;
  virtual std::optional<Ball> value(const Fraction& x) const = 0;
  virtual std::optional<Ball> conjugate(const Fraction& v) const = 0;
  /// f'(x) and (f*)'(v), where they exist.
  virtual std::optional<Ball> slope(const Fraction& x) const = 0;
  virtual std::optional<Ball> conjugate_slope(const Fraction& v) const = 0;
  /// The nearest number of the closed domain.
  virtual Fraction into_domain(const Fraction& x) const { return x; }
  virtual Fraction into_conjugate_domain(const Fraction& v) const { return v; }
  /// Where the domain of f* is open, or all of a half-line, it says more.
  virtual bool conjugate_is_infinite(const Fraction& v) const { return !(into_conjugate_domain(v) == v); }
};

/// The formulas of the entries of a separable function of the catalogue; empty for another call.
std::vector<std::unique_ptr<EntryFormula>> entry_formulas(const Call& call, std::size_t n);

/// A pair near x and v, entry by entry: of (x, v), ((f*)'(v), v) and (x, f'(x)) what proves most.
std::optional<ProofPair> pair_of_entries(const std::vector<std::unique_ptr<EntryFormula>>&,
                                         const Fractions& x, const Fractions& v);
/// A pair at x itself, or at v itself.
std::optional<ProofPair> entries_at_point(const std::vector<std::unique_ptr<EntryFormula>>&,
                                          const Fractions& x);
std::optional<ProofPair> entries_at_covector(const std::vector<std::unique_ptr<EntryFormula>>&,
                                             const Fractions& v);

/// f*(v) alone: the supremum need not be attained (e^x at v = 0). An infinite one is `is_infinite`.
struct ConjugateValue {
  bool is_infinite = false;
  FractionInterval between;
};
std::optional<ConjugateValue> conjugate_of_entries(const std::vector<std::unique_ptr<EntryFormula>>&,
                                                   const Fractions& v);

}  // namespace convex::inline proved_prox
