#include "mechanics/motion/taylor_magnitude.hpp"

#include <cmath>

namespace mechanics::inline motions {

using expression::Slot;
using Kind = TaylorStep::Kind;

namespace {

/// Of a product ab, whose factors are sums of a' and b': rounding moves it by about so many roundings of
/// |a| b' + a' |b|, and where a factor is nothing but rounding by those of a part of a' b'. The product a' b'
/// itself would grow with powers of a difference as those of its terms.
double of_product(double a, double of_a, double b, double of_b) {
  constexpr double part_of_rounding = 0x1p-40;
  return a * of_b + of_a * b - a * b + part_of_rounding * of_a * of_b;
}

}  // namespace

/// Orders above 0 of what never varies stay 0.
TaylorMagnitude::TaylorMagnitude(const TaylorSeries& series)
    : of_(series),
      m_(series.rows_.series * width()),
      c_(m_.size()),
      reach_(series.steps_->variables),
      slopes_(series.rows_.terms.size()) {}

void TaylorMagnitude::begin(std::span<const double> at_least) {
  const TaylorRows& rows = of_.rows_;
  for (std::size_t t = 0; t < slopes_.size(); ++t) slopes_[t] = std::abs(of_.terms_[t].c);
  for (std::size_t slot = 0; slot < of_.steps_->variables; ++slot)
    at(static_cast<Slot>(slot), 0) = std::max(reach_[slot], std::abs(of_[static_cast<Slot>(slot)][0]));
  for (std::size_t slot = 0; slot < at_least.size(); ++slot)
    at(static_cast<Slot>(slot), 0) = std::max(at(static_cast<Slot>(slot), 0), at_least[slot]);
  for (const auto& [slot, value] : of_.steps_->constants) at(slot, 0) = std::abs(value);
  for (std::size_t s = 0; s < of_.steps_->steps.size(); ++s) {
    begin_step(of_.steps_->steps[s], rows.row_of_step[s]);
    if (rows.row_of_step[s] != TaylorRows::none) amplify(of_.steps_->steps[s], rows.row_of_step[s]);
  }
}

/// Order 0 of a step.
void TaylorMagnitude::begin_step(const TaylorStep& step, std::uint32_t row) {
  const bool names_function = step.kind == Kind::arc;  // in the place of b
  const double a = at(step.a, 0), b = names_function ? 0 : at(step.b, 0);
  double& out = at(step.out, 0);
  const double f = std::abs(of_[step.out][0]);
  const auto slope = [&](std::size_t i) { return slopes_[of_.rows_.rows[row].first + i]; };
  switch (step.kind) {
    case Kind::sum:
    case Kind::difference:
      out = a + b;
      return;
    case Kind::negative:
    case Kind::absolute:
      out = a;
      return;
    case Kind::multiple:
      out = std::abs(step.number) * b;
      return;
    case Kind::share:
      out = a / std::abs(step.number);
      return;
    case Kind::product:
      out = of_product(std::abs(of_[step.a][0]), a, std::abs(of_[step.b][0]), b);
      return;
    case Kind::square:
      out = of_product(std::abs(of_[step.a][0]), a, std::abs(of_[step.a][0]), a);
      return;
    case Kind::sign:
      out = f;
      return;
    case Kind::where_not_negative:
    case Kind::where_negative:
      out = f > 0 ? b : 0;
      return;
    case Kind::either:
      out = of_[step.out][0] == of_[step.a][0] ? a : b;
      return;
    case Kind::quotient:
    case Kind::angle:
      out = f + slope(0) * a + slope(1) * b;
      return;
    case Kind::sine:
    case Kind::sinh:
    case Kind::tangent:
    case Kind::tanh: {
      out = f + slope(0) * a;
      const bool by_result = step.kind == Kind::tangent || step.kind == Kind::tanh;
      at(step.partner, 0) = std::abs(of_[step.partner][0]) + slope(1) * (by_result ? out : a);
      return;
    }
    default:
      out = f + slope(0) * a;
  }
}

/// Slopes are values of series themselves, with a rounding of their own.
void TaylorMagnitude::amplify(const TaylorStep& step, std::uint32_t row) {
  double* slope = slopes_.data() + of_.rows_.rows[row].first;
  switch (step.kind) {
    case Kind::product:
      slope[0] = at(step.b, 0);
      slope[1] = at(step.a, 0);
      return;
    case Kind::square:
      slope[0] = 2 * at(step.a, 0);
      return;
    case Kind::exponential:
      slope[0] = at(step.out, 0);
      return;
    case Kind::sine:
    case Kind::sinh:
      slope[0] = at(step.partner, 0);
      slope[1] = at(step.out, 0);
      return;
    default:
      return;
  }
}

/// |c_k| of a series, no more than what it is the sum of where that is not known.
double TaylorMagnitude::size(Slot series, int k) {
  return std::min(at(series, k), std::abs(k == 0 ? of_[series][0] : value(series, k)));
}

/// Of the products of a row, s R_k, and of Σ |s| |R_k|.
TaylorMagnitude::Rest TaylorMagnitude::rest(const TaylorRows::Row& row, int k) {
  Rest sum;
  for (std::uint32_t p = row.first_product; p < row.end_product; ++p) {
    const TaylorRows::Product& product = of_.rows_.products[p];
    Rest of_all;
    for (int j = 1; j < k; ++j) {
      const double weight = product.is_weighted ? static_cast<double>(j) / k : 1;
      of_all.value += weight * value(product.x, j) * value(product.y, k - j);
      of_all.magnitude += weight * of_product(size(product.x, j), at(product.x, j), size(product.y, k - j),
                                              at(product.y, k - j));
    }
    sum.value += product.scale * of_all.value;
    sum.magnitude += std::abs(product.scale) * of_all.magnitude;
  }
  return sum;
}

void TaylorMagnitude::find(std::size_t group, int k) {
  const TaylorRows& rows = of_.rows_;
  for (std::size_t r = group == 0 ? 0 : rows.ends[group - 1].rows; r < rows.ends[group].rows; ++r) {
    const TaylorRows::Row& row = rows.rows[r];
    Rest sum = rest(row, k);
    sum.value *= of_.factor_[r];
    sum.magnitude *= std::abs(of_.factor_[r]);
    for (std::uint32_t t = row.first; t < row.end; ++t) {
      const TaylorRows::Term& term = of_.terms_[t];
      sum.value += term.c * value(term.series, k);
      sum.magnitude += of_product(std::min(slopes_[t], std::abs(term.c)), slopes_[t], size(term.series, k),
                                  at(term.series, k));
    }
    value(row.out, k) = sum.value;
    at(row.out, k) = sum.magnitude;
  }
}

}  // namespace mechanics::inline motions
