#pragma once

#include "convex/exact_program/exact_program.hpp"
#include "convex/metric.hpp"

namespace convex::inline exact_programs {

/// The Gram matrix W of a metric in fractions, by rows of its nonzero entries.
struct ExactGram {
  std::vector<ExactRow> rows;
  bool is_diagonal = true;

  std::size_t dimension() const { return rows.size(); }
};

/// The doubles of a metric at their exact values.
ExactGram exact_gram(const Metric& W);
ExactGram identity_gram(std::size_t n);
/// From its rows; entries that mirror each other may differ by rounding, their mean is then meant. That it is
/// definite is for the metric of doubles, or a proof, to say.
ExactGram exact_gram(const std::vector<Fractions>& rows);
/// The block of rows and columns first … first + n - 1.
ExactGram block(const ExactGram& W, std::size_t first, std::size_t n);

/// W with its numbers rounded. Throws InvalidInput as Metric does.
Metric rounded(const ExactGram& W);

/// Wx.
Fractions multiply(const ExactGram& W, const Fractions& x);
/// x·Wx.
Fraction squared_norm(const ExactGram& W, const Fractions& x);

}  // namespace convex::inline exact_programs
