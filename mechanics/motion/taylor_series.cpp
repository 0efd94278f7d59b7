#include "mechanics/motion/taylor_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "convex/processor.hpp"
#include "mechanics/expression/operation.hpp"

namespace mechanics {
namespace {

using expression::Operation;
using expression::Slot;
using Kind = TaylorStep::Kind;

/// Four coefficients at a time.
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
constexpr std::size_t lanes = 4;

/// What order k of the factors adds to the orders above: R_(k+i) += x_k y_i + y_k x_i for 0 < i < k, and
/// R_2k += x_k y_k. Factors hold zeros from order k on, which the last four reach.
MOREAU_CLONES void add_products(const TaylorRows::Product* first, const TaylorRows::Product* last,
                                const double* c, const double* now, double* rest, std::size_t width,
                                std::size_t k, std::size_t order) {
  const std::size_t count = k < 2 || k >= order ? 0 : std::min(k - 1, order - k);
  for (; first != last; ++first) {
    const double xk = first->scale * now[first->x], yk = first->scale * now[first->y];
    double* R = rest + first->rest * width + k + 1;
    const double *x = c + first->x * width + 1, *y = c + first->y * width + 1;
    if (first->x == first->y) {
      for (std::size_t i = 0; i < count; i += lanes) {
        Four to, from;
        std::memcpy(&to, R + i, sizeof to);
        std::memcpy(&from, x + i, sizeof from);
        to += (2 * xk) * from;
        std::memcpy(R + i, &to, sizeof to);
      }
    } else {
      for (std::size_t i = 0; i < count; i += lanes) {
        Four to, from, with;
        std::memcpy(&to, R + i, sizeof to);
        std::memcpy(&from, y + i, sizeof from);
        std::memcpy(&with, x + i, sizeof with);
        to += xk * from + yk * with;
        std::memcpy(R + i, &to, sizeof to);
      }
    }
    if (2 * k <= order) R[k - 1] += xk * now[first->y];
  }
}

}  // namespace

TaylorSeries::TaylorSeries(const TaylorSteps& steps, const TaylorRows::Asked& asked, int order)
    : steps_(&steps),
      rows_(steps, asked),
      order_(order),
      width_((static_cast<std::size_t>(order) + 1 + 2 * lanes) / lanes * lanes),
      c_(rows_.series * width_),
      rest_(rows_.rests * width_),
      factor_(rows_.rows.size(), 1.0),
      now_(rows_.series),
      branches_(steps.switches.size(), 1.0) {
  for (const auto& [series, value] : steps.constants) at(series)[0] = value;
}

void TaylorSeries::begin(std::size_t group) {
  const std::size_t first = group == 0 ? 0 : steps_->ends[group - 1];
  for (std::size_t s = first; s < steps_->ends[group]; ++s) {
    const TaylorStep& step = steps_->steps[s];
    at(step.out)[0] = value(step);
    if (const std::uint32_t row = rows_.row_of_step[s]; row != TaylorRows::none) differentiate(step, row);
  }
}

/// Coefficient 0; that of the partner is set.
double TaylorSeries::value(const TaylorStep& step) {
  const double a = at(step.a)[0], b = step.kind == Kind::arc ? 0 : at(step.b)[0];
  double& partner = at(step.partner)[0];
  switch (step.kind) {
    case Kind::sum:
      return a + b;
    case Kind::difference:
      return a - b;
    case Kind::negative:
      return -a;
    case Kind::product:
      return a * b;
    case Kind::multiple:
      return step.number * b;
    case Kind::share:
      return a / step.number;
    case Kind::square:
      return a * a;
    case Kind::quotient:
      return a / b;
    case Kind::sine:
      partner = std::cos(a);
      return std::sin(a);
    case Kind::sinh:
      partner = std::cosh(a);
      return std::sinh(a);
    case Kind::tangent: {
      const double f = std::tan(a);
      partner = 1 + f * f;
      return f;
    }
    case Kind::tanh: {
      const double f = std::tanh(a);
      partner = expression::partials(Operation::tanh, a, a, f, {}).a;
      return f;
    }
    case Kind::exponential:
      return std::exp(a);
    case Kind::logarithm:
      return std::log(a);
    case Kind::root:
      return std::sqrt(a);
    case Kind::power:
      return std::pow(a, step.number);
    case Kind::arc:
      return expression::value(static_cast<Operation>(step.b), a, a);
    case Kind::angle:
      return std::atan2(a, b);
    case Kind::absolute:
      return branch(step) * a;
    case Kind::where_not_negative:
      return branch(step) >= 0 ? b : 0;
    case Kind::where_negative:
      return branch(step) < 0 ? b : 0;
    case Kind::either:
      return branch(step) > 0 ? a : b;
    case Kind::sign:
      return branch(step);
  }
  return 0;
}

/// The partial derivatives at order 0, from the equation of a function (Griewank and Walther 2008, section
/// 13.2), and the factor of what lower orders add to it.
void TaylorSeries::differentiate(const TaylorStep& step, std::uint32_t row) {
  const double a = at(step.a)[0], b = step.kind == Kind::arc ? 0 : at(step.b)[0];
  const double f = at(step.out)[0], p = at(step.partner)[0];
  TaylorRows::Term* by = rows_.terms.data() + rows_.rows[row].first;
  TaylorRows::Term& of_partner = by[1];  // the first one of the next row, where that belongs to the step
  double* factor = factor_.data() + row;
  switch (step.kind) {
    case Kind::product:
      by[0].c = b;
      by[1].c = a;
      return;
    case Kind::square:
      by[0].c = 2 * a;
      return;
    case Kind::quotient: {  // f b = a
      const double inverse = 1 / b;
      by[0].c = inverse;
      by[1].c = -f * inverse;
      factor[0] = -inverse;
      return;
    }
    case Kind::root: {  // f² = a
      const double inverse = 1 / (2 * f);
      by[0].c = inverse;
      factor[0] = -inverse;
      return;
    }
    case Kind::exponential:  // f' = f a'
      by[0].c = f;
      return;
    case Kind::logarithm:  // a f' = a'
      by[0].c = 1 / a;
      factor[0] = -1 / a;
      return;
    case Kind::sine:
      by[0].c = p;
      of_partner.c = -f;
      factor[1] = -1;
      return;
    case Kind::sinh:
      by[0].c = p;
      of_partner.c = f;
      return;
    case Kind::tangent:  // f' = (1 + f²) a'
      by[0].c = p;
      of_partner.c = 2 * f;
      return;
    case Kind::tanh:  // f' = (1 - f²) a'
      by[0].c = p;
      of_partner.c = -2 * f;
      factor[1] = -1;
      return;
    case Kind::arc:  // p f' = ± a'
      by[0].c = step.number / p;
      factor[0] = -1 / p;
      return;
    case Kind::angle:  // (a² + b²) f' = b a' - a b'
      by[0].c = b / p;
      by[1].c = -a / p;
      factor[0] = 1 / p;
      return;
    case Kind::power:  // a f' = e f a'
      by[0].c = step.number * f / a;
      factor[0] = 1 / a;
      return;
    case Kind::absolute:
      by[0].c = branch(step);
      return;
    case Kind::where_not_negative:
      by[0] = branch(step) >= 0 ? TaylorRows::Term{step.b, 1} : TaylorRows::Term{rows_.zero, 0};
      return;
    case Kind::where_negative:
      by[0] = branch(step) < 0 ? TaylorRows::Term{step.b, 1} : TaylorRows::Term{rows_.zero, 0};
      return;
    case Kind::either:
      by[0] = {branch(step) > 0 ? step.a : step.b, 1};
      return;
    default:
      return;
  }
}

void TaylorSeries::restart() {
  std::fill(rest_.begin(), rest_.end(), 0.0);
  for (const Slot series : rows_.joined) std::fill_n(at(series) + 1, width_ - 1, 0.0);
  degree_ = 0;
}

namespace {

/// Rows one after the other, each of which may read those before it.
struct RowOrder {
  const TaylorRows::Row* rows;
  const TaylorRows::Term* terms;
  const double *rest, *factor;  // R_k by rest, ρ by row
  std::size_t width;
  double order;
  double* now;

  void find(std::size_t number) const {
    const TaylorRows::Row row = rows[number];
    double sum = factor[number] * rest[row.rest * width];
    if (row.over_order) sum /= order;
    for (const TaylorRows::Term *term = terms + row.first, *end = terms + row.end; term != end; ++term)
      sum += term->c * now[term->series];
    now[row.out] = sum;
  }
};

}  // namespace

void TaylorSeries::find(std::size_t group, int k) {
  const RowOrder all{rows_.rows.data(),      rows_.terms.data(), rest_.data() + k, factor_.data(), width_,
                     static_cast<double>(k), now_.data()};
  const std::size_t end = rows_.ends[group].rows;
  for (std::size_t r = group == 0 ? 0 : rows_.ends[group - 1].rows; r < end; ++r) all.find(r);
}

void TaylorSeries::find_by_velocity(int k) {
  const RowOrder all{rows_.rows.data(),      rows_.terms.data(), rest_.data() + k, factor_.data(), width_,
                     static_cast<double>(k), now_.data()};
  for (const std::uint32_t r : rows_.after_velocity) all.find(r);
}

void TaylorSeries::finish(std::size_t groups, int k) {
  const TaylorRows::Ends& end = rows_.ends[groups - 1];
  for (std::size_t w = 0; w < end.weighted; ++w) now_[rows_.weighted[w].out] = k * now_[rows_.weighted[w].of];
  if (k < order_)
    add_products(rows_.products.data(), rows_.products.data() + end.products, c_.data(), now_.data(),
                 rest_.data(), width_, static_cast<std::size_t>(k), static_cast<std::size_t>(order_));
  bool is_zero = true;
  for (std::size_t j = 0; j < end.joined; ++j) {
    const Slot series = rows_.joined[j];
    at(series)[k] = now_[series];
    is_zero = is_zero && now_[series] == 0;
  }
  if (!is_zero) degree_ = k;
}

void TaylorSeries::carry(std::vector<double>& change, std::size_t count) const {
  for (const std::uint32_t r : rows_.by_velocity) {
    const TaylorRows::Row& row = rows_.rows[r];
    double* f = change.data() + row.out * count;
    std::fill(f, f + count, 0.0);
    for (std::uint32_t t = row.first; t < row.end; ++t) {
      const TaylorRows::Term& term = rows_.terms[t];
      const double* a = change.data() + term.series * count;
      for (std::size_t l = 0; l < count; ++l) f[l] += term.c * a[l];
    }
  }
}

double value_at(std::span<const double> c, double tau) {
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * tau + c[k];
  return sum;
}

double slope_at(std::span<const double> c, double tau) {
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 1;) sum = sum * tau + static_cast<double>(k) * c[k];
  return sum;
}

}  // namespace mechanics
