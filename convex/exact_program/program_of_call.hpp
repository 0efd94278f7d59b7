#pragma once

#include <optional>

#include "convex/exact_program/exact_gram.hpp"
#include "convex/gamma0/call.hpp"

namespace convex::inline exact_programs {

/// The function, or the indicator of the set, that a call means in the space with the product of W, as a
/// program in fractions. None when it is not piecewise linear-quadratic, or its numbers make it no convex
/// function before rounding (pieces that do not meet, a Q with a negative eigenvalue). The call is one that
/// `make_function` has taken there. It is made from the call alone, by other code than the functions in
/// doubles.
std::optional<ExactProgram> exact_program(const Call& call, const ExactGram& W);

/// Of the sets and functions without parts; none of other names.
std::optional<ExactProgram> of_set(const Call& call, std::size_t n);
std::optional<ExactProgram> of_function(const Call& call, std::size_t n);

/// One piece c2/2 x² + c1 x + c0 of a function of one entry; an end that is not there is infinite.
struct ExactPiece {
  std::optional<Fraction> low, high;
  Fraction c2, c1, c0;
};

/// Σ_i p(x_i); none when the pieces do not meet, or the slope falls.
std::optional<ExactProgram> of_pieces(std::size_t n, const std::vector<ExactPiece>& pieces);

/// Of one entry: a distance, and a maximum of parts of which none is polyhedral beside the others, in pieces
/// that meet at fractions; none of anything else.
std::optional<ExactProgram> of_one_variable(const Call& call, const ExactGram& W);

/// Whether a symmetric matrix, by rows, is positive semidefinite.
bool is_semidefinite(std::vector<ExactRow> Q);

}  // namespace convex::inline exact_programs
