#pragma once

#include <memory>
#include <vector>

#include "convex/composite/graph_form.hpp"
#include "convex/exact_program/exact_program.hpp"

namespace convex::inline composite {

/// An entry of a curved function whose slope far out is finite on one side at least: where it moves to that
/// side, it comes to a line.
struct CurvedEntry {
  std::size_t term;
  Index row;
  ExactRow u;
  bool up, down;  ///< the sides
};

/// The part of a term that is a sum over its entries: itself, or the function of an epigraph; null elsewhere.
std::shared_ptr<const Atom> curved_sum(const GraphTerm& term);

/// Equations, each solved for an unknown that stands in no later one.
class SolvedEquations {
 public:
  void solve(ExactRow row);
  void take_out(ExactRow& row) const;
  /// The unknowns that they are solved for, from the others.
  void fill(Fractions& xi) const;

 private:
  std::vector<std::pair<std::size_t, ExactRow>> solved_;
};

/// The directions d of w with F∞(0, d) <= 0, by rows over d and auxiliary variables.
class RecedingDirections {
 public:
  explicit RecedingDirections(const GraphForm& f);

  /// One along which as many of the curved entries move to a line as can, w and then the auxiliary variables
  /// of the programs; empty where none can.
  Fractions direction() const;

  /// Those that may move.
  const std::vector<CurvedEntry>& entries() const { return entries_; }
  bool is_within_reach() const;

 private:
  struct Side {
    const CurvedEntry* entry;
    double sign;
  };

  /// What is at least f∞(u) under the rows that are added, and is f∞(u) where they are tight.
  ExactRow recession(const Atom& f, const std::vector<ExactRow>& u, std::size_t term);
  ExactRow recession_of_entry(const Atom& f, Index i, const ExactRow& u, Index size, std::size_t term);
  ExactRow recession_of_program(const LinearQuadratic& cone, const std::vector<ExactRow>& u);
  /// Where all that may move stands still by the equations alone, there is nothing to look for.
  void settle_equations();
  /// Adds to d a direction along which as many of these entries as can move to the sides told.
  bool take(const std::vector<Side>& sides, Fractions& d) const;

  std::size_t k_, next_;
  ExactRow total_;
  SolvedEquations equations_;
  std::vector<ExactBound> rows_;
  std::vector<CurvedEntry> entries_;
};

}  // namespace convex::inline composite
