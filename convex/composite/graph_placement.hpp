#pragma once

#include "convex/composite/graph_form.hpp"

/// Maps between the ξ of a graph form and that of a larger one that it becomes a part of.
namespace convex::inline composite {

/// ξ of a form with k auxiliary variables from a ξ of `columns` entries: x = x_part ξ, w from `w_start` on.
SparseMatrix placed(Index columns, const SparseMatrix& x_part, Index w_start, Index k);

/// Entries first, …, first + rows - 1 of a ξ of `columns` entries, times a factor.
SparseMatrix selection(Index first, Index rows, Index columns, double factor = 1);

/// Adds the terms of f at place · ξ + (b, 0), and its constant, to `sum`.
void add_terms(GraphForm& sum, const GraphForm& f, const SparseMatrix& place, const Vector& b);

/// a and constant when f is a·u + constant on Rⁿ.
std::optional<QuadraticForm> linear_form(const Atom& f, Index n);

/// a·Mξ as a term.
GraphTerm linear_term(const SparseMatrix& M, const Vector& a);

}  // namespace convex::inline composite
