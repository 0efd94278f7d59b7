#include "mechanics/motion/taylor_series.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/expression/operation.hpp"
#include "mechanics/expression/rounded.hpp"

namespace mechanics::inline motions {
namespace {

using expression::Operation;
using expression::Slot;
using Kind = TaylorStep::Kind;

/// Where each series begins, and the end: of those that are not kept there is order 0 alone.
std::vector<std::size_t> places(const TaylorProgram& of, std::size_t width) {
  std::vector<bool> is_whole(of.rows.series);
  for (const Slot series : of.kept) is_whole[series] = true;
  for (std::size_t variable = 0; variable < of.steps.variables; ++variable) is_whole[variable] = true;
  std::vector<std::size_t> place(of.rows.series + 1);
  std::size_t next = 0;
  for (const bool whole : {false, true})
    for (std::size_t series = 0; series < of.rows.series; ++series)
      if (is_whole[series] == whole) {
        place[series] = next;
        next += whole ? width : 1;
      }
  place.back() = next;
  return place;
}

/// The root of the largest double.
constexpr double far = 0x1p512;

std::span<const TaylorRows::Product> first_products(const TaylorRows& rows, std::size_t groups) {
  return {rows.products.data(), rows.ends[groups - 1].products};
}

}  // namespace

TaylorSeries::TaylorSeries(const TaylorProgram& of, int order)
    : steps_(&of.steps),
      rows_(of.rows),
      terms_(of.rows.terms),
      order_(order),
      groups_(groups_with_orders(of.steps)),
      products_(first_products(rows_, groups_), order),
      kept_(of.kept),
      free_(of.matrix, order),
      width_(blocks_of(static_cast<std::size_t>(order) + 1) * Eight::count),
      place_(places(of, width_)),
      c_(place_.back()),
      factor_(rows_.rows.size(), 1.0),
      now_(rows_.series),
      branches_(of.steps.switches.size(), 1.0) {
  for (const auto& [series, value] : of.steps.constants) at(series)[0] = value;
  if (std::none_of(of.steps.steps.begin(), of.steps.steps.end(), takes_base)) return;
  stays_zero_.resize(rows_.series);
  known_.assign(rows_.series, order_ + 1);
  for (const auto& [series, value] : of.steps.constants) stays_zero_[series] = value == 0;
}

void TaylorSeries::begin(std::size_t group) {
  if (group == 0) without_bound_ = 0;
  const std::size_t first = group == 0 ? 0 : steps_->ends[group - 1];
  for (std::size_t s = first; s < steps_->ends[group]; ++s) {
    const TaylorStep& step = steps_->steps[s];
    at(step.out)[0] = value(step);
    if (!stays_zero_.empty()) {
      stays_zero_[step.out] = stays_zero(step);
      known_[step.out] = known(step);
      if (has_partner(step)) known_[step.partner] = known_[step.out];
    }
    if (const std::uint32_t row = rows_.row_of_step[s]; row != TaylorRows::none) differentiate(step, row);
  }
}

void TaylorSeries::find_values(std::size_t group) {
  const std::size_t first = group == 0 ? 0 : steps_->ends[group - 1];
  for (std::size_t s = first; s < steps_->ends[group]; ++s)
    at(steps_->steps[s].out)[0] = value(steps_->steps[s]);
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
      return std::sqrt(base(step));
    case Kind::power:
      return std::pow(base(step), step.number);
    case Kind::arc:
      return expression::value(static_cast<Operation>(step.b), a, a);
    case Kind::angle:
      return expression::atan2(a, b);
    case Kind::absolute:  // what rounding leaves of an argument at 0 may be on the other side
      return branch(step) == 0 ? 0 : std::abs(a);
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
  TaylorRows::Term* by = terms_.data() + rows_.rows[row].first;
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
      // Of b the next orders may be beyond what doubles hold, and f is nothing beside what they do.
      if (std::abs(b) > far && std::abs(f) < 1 / far) {
        by[0] = by[1] = {rows_.zero, 0};
        factor[0] = 0;
        return;
      }
      by[0] = {step.a, inverse};
      by[1] = {step.b, -f * inverse};
      factor[0] = -inverse;
      return;
    }
    case Kind::root: {  // f² = a
      if (base(step) == 0) return differentiate_at_zero(step, 0.5, by[0].c, factor[0]);
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
      if (step.number > 0 && base(step) == 0)
        return differentiate_at_zero(step, step.number, by[0].c, factor[0]);
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
  for (const Slot series : kept_) std::fill_n(at(series) + 1, width_ - 1, 0.0);
  degree_ = 0;
  found_ = order_;
}

void TaylorSeries::cut() {
  for (const Slot series : kept_) {
    double *const first = at(series), *const end = first + width_;
    std::fill(std::find_if_not(first + 1, end, [](double c) { return std::isfinite(c); }), end, 0.0);
  }
}

/// Rows are found one after the other: each may read those before it.
double TaylorSeries::of_row(std::size_t number) const {
  const TaylorRows::Row& row = rows_.rows[number];
  double sum = 0;
  if (factor_[number] != 0) {  // else they need not be finite
    for (std::uint32_t p = row.first_product; p < row.end_product; ++p)
      sum += rows_.products[p].scale * products_.rest()[p];
    sum *= factor_[number];
  }
  for (std::uint32_t t = row.first; t < row.end; ++t) sum += terms_[t].c * now_[terms_[t].series];
  return sum;
}

void TaylorSeries::find_at_rest(int k) {
  products_.find(k);
  for (std::size_t r = 0; r < rows_.ends[0].rows; ++r) now_[rows_.rows[r].out] = of_row(r);
}

void TaylorSeries::find(int k) {
  for (const std::uint32_t r : rows_.after_velocity) now_[rows_.rows[r].out] = of_row(r);
  for (std::size_t r = rows_.ends[0].rows; r < rows_.ends[groups_ - 1].rows; ++r)
    now_[rows_.rows[r].out] = of_row(r);
  products_.take(now_.data(), k);
  for (const Slot series : kept_) at(series)[k] = now_[series];
  if (!order_is_zero(k)) degree_ = k;
}

/// All series of an order are linear in the variables and the rests.
bool TaylorSeries::order_is_zero(int k) const {
  const std::size_t moving = steps_->variables - 1;  // time itself has no coefficient above 1
  return k > 1 &&
         std::all_of(now_.begin(), now_.begin() + static_cast<std::ptrdiff_t>(moving),
                     [](double x) { return x == 0; }) &&
         products_.are_zero();
}

bool TaylorSeries::find_free(const InertiaFactor& A, std::span<const double> force) {
  if (!free_.pays()) return false;
  const std::size_t n = force.size();
  velocity_.resize(n);
  for (std::size_t i = 0; i < n; ++i) velocity_[i] = at(static_cast<Slot>(n + i))[0];
  if (!free_.find(rows_, terms_.data(), factor_.data(), A, velocity_.data(), force.data())) return false;
  const int end = free_.end();
  found_ = end;
  for (std::size_t which = 0; which < kept_.size(); ++which) {
    if (kept_[which] < n) continue;  // a coordinate
    double* c = at(kept_[which]);
    for (int k = 1; k < end; ++k) c[k] = free_.kept(which, k);
    std::fill(c + end, c + width_, 0.0);
  }
  for (std::size_t i = 0; i < n; ++i) {
    double* q = at(static_cast<Slot>(i));
    free_.positions(i, q);
    std::fill(q + end + 1, q + width_, 0.0);
    now_[n + i] = free_.velocity(static_cast<Index>(i), 1);
  }
  return true;
}

double value_at(std::span<const double> c, double tau) {
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * tau + c[k];
  return sum;
}

double slope_at(std::span<const double> c, double tau) {
  double sum = 0;
  std::size_t count = c.size();
  while (count > 0 && c[count - 1] == 0) --count;  // of which a polynomial has many
  for (std::size_t k = count; k-- > 1;) sum = sum * tau + static_cast<double>(k) * c[k];
  return sum;
}

}  // namespace mechanics::inline motions
