#pragma once

#include <gmpxx.h>

#include <vector>

namespace oracles {

/// Numbers without rounding: a double is the fraction that it stands for.
using Rational = mpq_class;
using RationalVector = std::vector<Rational>;

/// Row-reduces [M | b] in place, M of so many columns; returns the pivot column of each nonzero row of M.
std::vector<std::size_t> row_reduce(std::vector<RationalVector>& M, std::size_t columns);

}  // namespace oracles
