#pragma once

#include <gmpxx.h>

#include <optional>
#include <random>
#include <vector>

#include "convex/piecewise/pieces.hpp"

namespace oracles {

using Rational = mpq_class;

/// A piecewise linear-quadratic function in fractions, evaluated from its rows; +inf is none.
struct RationalPieces {
  std::vector<Rational> breaks;
  std::vector<std::optional<std::vector<Rational>>> rows;  // c2, c1, c0; none where +inf

  explicit RationalPieces(const convex::Pieces&);
  std::optional<Rational> value(const Rational& x) const;
};

/// The best of finitely many candidates, among which the optimum has to be: every break and every stationary
/// point of every piece (of every pair of pieces). Quadratic in the pieces and obviously right.
std::optional<Rational> conjugate_value(const RationalPieces& f, const Rational& y);
/// None where it is +inf.
std::optional<Rational> inf_convolution_value(const RationalPieces& f, const RationalPieces& g,
                                              const Rational& x);

enum class Ends { line, left, right, bounded, point };

/// A random function whose coefficients are small multiples of powers of two, so that doubles are exact on it
/// and, c2 being a power of two, on its conjugate.
convex::Pieces dyadic_pieces(std::mt19937& generator, int count, Ends ends);
/// A random one of full mantissa, rows rounded.
convex::Pieces rounded_pieces(std::mt19937& generator, int count, Ends ends);

constexpr Ends all_ends[] = {Ends::line, Ends::left, Ends::right, Ends::bounded, Ends::point};

}  // namespace oracles
