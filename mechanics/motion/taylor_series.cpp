#include "mechanics/motion/taylor_series.hpp"

#include <cmath>

#include "mechanics/expression/operation.hpp"

namespace mechanics {
namespace {

using expression::Operation;
using expression::Slot;
using Kind = TaylorStep::Kind;

/// Σ_(j=first)^(last) x_j y_(k-j).
double convolution(const double* x, const double* y, std::size_t first, std::size_t last, std::size_t k) {
  double sum = 0;
  for (std::size_t j = first; j <= last; ++j) sum += x[j] * y[k - j];
  return sum;
}

/// Σ_(j=first)^(last) j x_j y_(k-j) / k: coefficient k of the integral of x' y, or a part of it.
double linked(const double* x, const double* y, std::size_t first, std::size_t last, std::size_t k) {
  double sum = 0;
  for (std::size_t j = first; j <= last; ++j) sum += static_cast<double>(j) * (x[j] * y[k - j]);
  return sum / static_cast<double>(k);
}

double square(const double* x, std::size_t k) {
  double sum = 0;
  for (std::size_t j = 0; 2 * j < k; ++j) sum += x[j] * x[k - j];
  sum *= 2;
  if (k % 2 == 0) sum += x[k / 2] * x[k / 2];
  return sum;
}

}  // namespace

TaylorSeries::TaylorSeries(const TaylorSteps& steps, int order)
    : steps_(&steps),
      order_(order),
      width_(static_cast<std::size_t>(order) + 1),
      c_(steps.series * width_),
      branches_(steps.switches.size(), 1.0) {
  for (const auto& [series, value] : steps.constants) at(series)[0] = value;
}

/// Coefficient 0.
void TaylorSeries::begin(const TaylorStep& step) {
  const double a = at(step.a)[0], b = at(step.b)[0];
  double& f = at(step.out)[0];
  switch (step.kind) {
    case Kind::sine:
      f = std::sin(a);
      at(step.partner)[0] = std::cos(a);
      return;
    case Kind::sinh:
      f = std::sinh(a);
      at(step.partner)[0] = std::cosh(a);
      return;
    case Kind::tangent:
      f = std::tan(a);
      at(step.partner)[0] = 1 + f * f;
      return;
    case Kind::tanh:
      f = std::tanh(a);
      at(step.partner)[0] = expression::partials(Operation::tanh, a, a, f, {}).a;
      return;
    case Kind::exponential:
      f = std::exp(a);
      return;
    case Kind::logarithm:
      f = std::log(a);
      return;
    case Kind::root:
      f = std::sqrt(a);
      return;
    case Kind::power:
      f = std::pow(a, step.number);
      return;
    case Kind::arc:
      f = expression::value(static_cast<Operation>(step.b), a, a);
      return;
    case Kind::angle:
      f = std::atan2(a, b);
      return;
    default:
      extend(step, 0);
  }
}

/// Coefficient k, of the functions that have a differential equation for k > 0 (Griewank and Walther 2008,
/// section 13.2).
void TaylorSeries::extend(const TaylorStep& step, std::size_t k) {
  const double *a = at(step.a), *b = at(step.b);
  double *f = at(step.out), *p = at(step.partner);
  switch (step.kind) {
    case Kind::sum:
      f[k] = a[k] + b[k];
      return;
    case Kind::difference:
      f[k] = a[k] - b[k];
      return;
    case Kind::negative:
      f[k] = -a[k];
      return;
    case Kind::product:
      f[k] = convolution(a, b, 0, k, k);
      return;
    case Kind::multiple:
      f[k] = step.number * b[k];
      return;
    case Kind::share:
      f[k] = a[k] / step.number;
      return;
    case Kind::square:
      f[k] = square(a, k);
      return;
    case Kind::quotient:  // f b = a
      f[k] = (k == 0 ? a[0] : a[k] - convolution(b, f, 1, k, k)) / b[0];
      return;
    case Kind::root: {  // f² = a
      double rest = 0;
      for (std::size_t j = 1; 2 * j < k; ++j) rest += f[j] * f[k - j];
      rest = a[k] - 2 * rest;
      if (k % 2 == 0) rest -= f[k / 2] * f[k / 2];
      f[k] = rest / (2 * f[0]);
      return;
    }
    case Kind::exponential:  // f' = f a'
      f[k] = linked(a, f, 1, k, k);
      return;
    case Kind::logarithm:  // a f' = a'
      f[k] = (a[k] - linked(f, a, 1, k - 1, k)) / a[0];
      return;
    case Kind::sine:
      f[k] = linked(a, p, 1, k, k);
      p[k] = -linked(a, f, 1, k, k);
      return;
    case Kind::sinh:
      f[k] = linked(a, p, 1, k, k);
      p[k] = linked(a, f, 1, k, k);
      return;
    case Kind::tangent:  // f' = (1 + f²) a'
      f[k] = linked(a, p, 1, k, k);
      p[k] = square(f, k);
      return;
    case Kind::tanh:  // f' = (1 - f²) a'
      f[k] = linked(a, p, 1, k, k);
      p[k] = -square(f, k);
      return;
    case Kind::arc:  // p f' = ± a'
      f[k] = (step.number * a[k] - linked(f, p, 1, k - 1, k)) / p[0];
      return;
    case Kind::angle:  // (a² + b²) f' = b a' - a b'
      f[k] = (linked(a, b, 1, k, k) - linked(b, a, 1, k, k) - linked(f, p, 1, k - 1, k)) / p[0];
      return;
    case Kind::power: {  // a f' = e f a'
      double sum = 0;
      for (std::size_t j = 1; j <= k; ++j)
        sum += (step.number * static_cast<double>(j) - static_cast<double>(k - j)) * (a[j] * f[k - j]);
      f[k] = sum / (static_cast<double>(k) * a[0]);
      return;
    }
    case Kind::absolute:
      f[k] = branch(step) * a[k];
      return;
    case Kind::where_not_negative:
      f[k] = branch(step) > 0 ? b[k] : 0;
      return;
    case Kind::where_negative:
      f[k] = branch(step) < 0 ? b[k] : 0;
      return;
    case Kind::either:
      f[k] = branch(step) > 0 ? a[k] : b[k];
      return;
    case Kind::sign:
      f[k] = k == 0 ? branch(step) : 0;
      return;
  }
}

void TaylorSeries::advance(std::size_t group, int k) {
  const std::size_t first = group == 0 ? 0 : steps_->ends[group - 1];
  for (std::size_t s = first; s < steps_->ends[group]; ++s) {
    if (k == 0)
      begin(steps_->steps[s]);
    else
      extend(steps_->steps[s], static_cast<std::size_t>(k));
  }
}

void TaylorSeries::carry(std::vector<double>& change, std::size_t lanes) const {
  for (const std::size_t s : steps_->by_velocity) {
    const TaylorStep& step = steps_->steps[s];
    const double a0 = at(step.a)[0], b0 = at(step.b)[0];
    const double *a = change.data() + step.a * lanes, *b = change.data() + step.b * lanes;
    double* f = change.data() + step.out * lanes;
    for (std::size_t l = 0; l < lanes; ++l) switch (step.kind) {
        case Kind::sum:
          f[l] = a[l] + b[l];
          break;
        case Kind::difference:
          f[l] = a[l] - b[l];
          break;
        case Kind::negative:
          f[l] = -a[l];
          break;
        case Kind::product:
          f[l] = a0 * b[l] + b0 * a[l];
          break;
        case Kind::multiple:
          f[l] = step.number * b[l];
          break;
        case Kind::square:
          f[l] = 2 * a0 * a[l];
          break;
        case Kind::share:
          f[l] = a[l] / step.number;
          break;
        case Kind::where_not_negative:
          f[l] = branch(step) > 0 ? b[l] : 0;
          break;
        case Kind::where_negative:
          f[l] = branch(step) < 0 ? b[l] : 0;
          break;
        default:  // a quotient; its divisor does not depend on velocities
          f[l] = a[l] / b0;
      }
  }
}

void TaylorSeries::correct(int k, std::span<const double> change) {
  for (const std::size_t s : steps_->by_velocity) {
    const Slot out = steps_->steps[s].out;
    at(out)[k] += change[out];
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
