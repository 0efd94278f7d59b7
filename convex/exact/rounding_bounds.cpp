#include "convex/exact/rounding_bounds.hpp"

#include "convex/processor.hpp"

namespace convex::inline exact_arithmetic {
namespace {

constexpr double splitter = 0x1p27 + 1;  // Dekker 1971

/// One term of Dot2: sum + rest += x y, exact but for the rounding of rest.
[[gnu::always_inline]] inline void add_term(double x, double y, double y_high, double y_low, double& sum,
                                            double& rest) {
  const double product = x * y;
  const double scaled = splitter * x, x_high = scaled - (scaled - x), x_low = x - x_high;
  const double product_rest =
      x_low * y_low - (((product - x_high * y_high) - x_low * y_high) - x_high * y_low);
  const double total = sum + product, part = total - sum;
  rest += ((sum - (total - part)) + (product - part)) + product_rest;
  sum = total;
}

MOREAU_CLONES void add_terms(Index n, const double* x, double y, double* sum, double* rest,
                             double* magnitude) {
  const double scaled = splitter * y, y_high = scaled - (scaled - y), y_low = y - y_high;
  const double size = std::abs(y);
  for (Index i = 0; i < n; ++i) {
    add_term(x[i], y, y_high, y_low, sum[i], rest[i]);
    magnitude[i] += std::abs(x[i]) * size;
  }
}

/// Ogita, Rump and Oishi 2005, proposition 5.5: u |result| + gamma_n² Σ|x_i y_i|, and a little more.
double radius(double value, double magnitude, Index terms) {
  return above(2 * unit_roundoff * std::abs(value) + gamma(terms) * gamma(terms) * magnitude);
}

}  // namespace

void CompensatedSum::add(double x, double y) {
  if (y == 0) return;
  const double scaled = splitter * y, y_high = scaled - (scaled - y), y_low = y - y_high;
  add_term(x, y, y_high, y_low, sum_, rest_);
  magnitude_ += std::abs(x * y);
  ++terms_;
}

Enclosed CompensatedSum::result() const {
  const double value = sum_ + rest_;
  return {value, radius(value, magnitude_, terms_)};
}

CompensatedSums::CompensatedSums(Index n)
    : sum_(Vector::Zero(n)), rest_(Vector::Zero(n)), magnitude_(Vector::Zero(n)) {}

void CompensatedSums::add(const double* x, double y) {
  if (y == 0) return;
  add_terms(sum_.size(), x, y, sum_.data(), rest_.data(), magnitude_.data());
  ++terms_;
}

void CompensatedSums::result(Vector& value, Vector& radii) const {
  value = sum_ + rest_;
  radii.resize(value.size());
  for (Index i = 0; i < value.size(); ++i) radii[i] = radius(value[i], magnitude_[i], terms_);
}

}  // namespace convex::inline exact_arithmetic
