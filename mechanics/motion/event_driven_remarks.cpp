#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/polynomial_root.hpp"
#include "mechanics/motion/taylor_series.hpp"
#include "mechanics/motion/terms.hpp"
#include "mechanics/number_text.hpp"

/// What is said of impacts whose times rounding leaves open, and of what keeps a motion from going on.
namespace mechanics::inline motions {
namespace {

/// A product of gradients that do not move each other is left by so many roundings of their lengths.
constexpr double roundings_of_product = 64;

/// Ahead is where time, or a coordinate, has gone by this part of what it is: far beyond rounding, and short
/// of what comes later.
constexpr double part_ahead = 0x1p-32;

double time_ahead(const State& at) {
  double scale = at.t != 0 ? std::abs(at.t) : std::numeric_limits<double>::infinity();
  for (Index i = 0; i < at.q.size(); ++i)
    if (const double time = std::abs(at.q[i] / at.v[i]); time > 0) scale = std::min(scale, time);
  return part_ahead * (std::isfinite(scale) ? scale : 1);  // from 0 any step leads away
}

double polynomial_at(std::span<const double> c, double at) {
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * at + c[k];
  return sum;
}

/// How far from τ a polynomial stays within `rounding` of p(τ), up to a factor of 2: back to 0, and as far
/// `ahead`. Near a zero of order p this is (rounding/c)^(1/p), far more than the slope tells.
double width_of_zero(std::span<const double> c, double tau, double ahead, double rounding, double least) {
  const double there = polynomial_at(c, tau);
  const auto width = [&](double sense, double most) {
    double w = std::min(std::max(least, std::numeric_limits<double>::min()), most);
    while (w < most && std::abs(polynomial_at(c, tau + sense * w) - there) <= rounding)
      w = std::min(2 * w, most);
    return w;
  };
  return std::max(width(-1, tau), width(1, ahead));
}

/// A derivative of a polynomial is left by so many roundings of what it is the sum of.
constexpr double roundings_of_derivative = 16;

/// Points of the time over which f is within its rounding between which df/dt turns around at most once.
constexpr int looks_at_rate = 32;

/// A polynomial's second derivative, and what it is the sum of.
struct Curvature {
  double value = 0, terms = 0;
};

Curvature curvature(std::span<const double> c, double at) {
  Curvature sum;
  for (std::size_t k = c.size(); k-- > 2;) {
    const double term = static_cast<double>(k * (k - 1)) * c[k];
    sum = {sum.value * at + term, sum.terms * at + std::abs(term)};
  }
  return sum;
}

/// Whether the derivative is 0 but for rounding.
bool is_level(std::span<const double> c, double at) {
  double terms = 0;
  for (std::size_t k = c.size(); k-- > 1;) terms = terms * at + static_cast<double>(k) * std::abs(c[k]);
  return std::abs(slope_at(c, at)) <= roundings_of_derivative * epsilon * terms;
}

/// Where the derivative, within an interval, comes up to 0 but for rounding, and surely falls again; else
/// nothing.
std::optional<double> end_of_fall(std::span<const double> c, double from, double to) {
  const auto look = [&](int k) { return from + (to - from) * k / looks_at_rate; };
  int highest = 0;
  for (int k = 1; k <= looks_at_rate; ++k)
    if (slope_at(c, look(k)) > slope_at(c, look(highest))) highest = k;
  if (highest == 0 || highest == looks_at_rate) return std::nullopt;
  double low = look(highest - 1), high = look(highest + 1);
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
    (curvature(c, middle).value > 0 ? low : high) = middle;
  for (double later = epsilon * to; is_level(c, high) && high + later < to; later *= 2) {
    const Curvature there = curvature(c, high + later);
    if (!(there.value < -roundings_of_derivative * epsilon * there.terms)) continue;
    if (is_level(c, high + later)) return high + later;
    break;
  }
  return std::nullopt;
}

}  // namespace

/// Where f comes to 0 as (t₀ - t)^p, p = 3, 5, …, it stays within its rounding for long, and rounding decides
/// where in that time it crosses 0, with a speed that makes a hundred bounces which are none. df/dt tells:
/// its zero is of a lower order, and the contact lands there, softly.
void Motion::EventDriven::land_softly(Zero& zero, double end) const {
  if (zero.of != Zero::Of::constraint || zero.is_touch) return;
  const std::span<const double> c = coefficients(next.f, zero.which);
  const double rounding = epsilon * (expansion_.position_scale(zero.which) + sum_of_terms(c, zero.at));
  const double by_slope = rounding / std::abs(slope_at(c, zero.at));
  const double known = options.tolerance * (clock() + zero.at);
  if (!(2 * most_coefficients * by_slope > known)) return;
  const double width = width_of_zero(c, zero.at, end - zero.at, rounding, std::min(by_slope, known));
  const auto landed = end_of_fall(c, std::max(0.0, zero.at - width), std::min(end, zero.at + width));
  zero.is_soft = landed.has_value();
  zero.at = landed.value_or(zero.at);
}

bool Motion::EventDriven::turns_within_rounding(Index a) {
  const std::span<const double> c = coefficients(done.f, a);
  const double rate = expansion_.rate(a), bend = curvature(c, done.length).value;
  if (!(bend > 0)) return false;
  const double rounding =
      std::max(rounding_of_f(a), roundings_of_closed * epsilon * expansion_.magnitude_of_constraint(a)) +
      epsilon * sum_of_terms(c, done.length);
  return rate * rate <= 2 * bend * rounding;
}

/// Of a contact that closes. Without t, its terms are about as large as those of its differential.
double Motion::EventDriven::rounding_of_f(Index a) {
  if (!expansion_.uses_time()) return epsilon * expansion_.position_scale(a);
  return epsilon * (expansion_.magnitude_of_constraint(a) + std::abs(state.t * expansion_.rate(a)));
}

/// Near a tangency f falls so slowly through 0 that its rounding leaves the time of the impact uncertain. The
/// last bounces before rest do so too: their end is told with its own error.
void Motion::EventDriven::tell_blur(const std::vector<Zero>& zeros) {
  for (const Zero& zero : zeros) {
    if (zero.of != Zero::Of::constraint || zero.is_touch) continue;
    const Index a = zero.which;
    const auto k = static_cast<std::size_t>(a);
    const bool has_known_end = std::isfinite(history_[k].end_error());
    if (is_blurred_[k] || has_known_end) continue;
    const std::span<const double> c = coefficients(done.f, a);
    const double rounding = rounding_of_f(a) + epsilon * sum_of_terms(c, done.length);
    const double rate = expansion_.rate(a), known = options.tolerance * clock();
    const bool is_soft = zero.is_soft || !(rate < -expansion_.rounding_of_rate(a));
    if (!is_soft && -rate <= expansion_.rounding_of_rate_so_far(a))
      remark(RemarkKind::speed,
             constraint_name(a) +
                 " closes with a speed that rounding may have made of the speeds before it: "
                 "whether it does, and when, is not determined by the data");
    const double by_slope = is_soft ? known : rounding / -rate;
    // The width of a zero of order p is about 2 p times that.
    if (!(2 * most_coefficients * by_slope > known)) continue;
    const double blur =
        std::max(by_slope, width_of_zero(c, done.length, 2 * step_ahead_, rounding, by_slope));
    if (!(blur > known)) continue;
    is_blurred_[k] = true;
    history_[k].doubt(blur, std::abs(rate));
    remark(RemarkKind::slow_closing,
           constraint_name(a) + " closes so slowly that the rounding of f leaves the time uncertain by " +
               number_text(blur) + ", and with it what follows",
           blur);
  }
}

/// Contacts that close one after the other, as far as their times tell, but within the rounding of t, are one
/// impact: where one of them moves the other, the order would have mattered.
void Motion::EventDriven::tell_order(const std::vector<Zero>& zeros, const std::vector<Index>& closing) {
  const convex::Metric& A = expansion_.inertia();
  const auto time = [&](Index a) {
    return std::find_if(zeros.begin(), zeros.end(),
                        [&](const Zero& zero) { return zero.of == Zero::Of::constraint && zero.which == a; })
        ->at;
  };
  for (std::size_t i = 0; i < closing.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (time(closing[i]) == time(closing[j])) continue;
      const Vector u = A.whiten(expansion_.row(closing[i])), w = A.whiten(expansion_.row(closing[j]));
      if (std::abs(u.dot(w)) <= roundings_of_product * epsilon * u.norm() * w.norm()) continue;
      return remark(RemarkKind::order,
                    constraint_name(closing[j]) + " and " + constraint_name(closing[i]) +
                        " close at times that rounding hardly tells apart and are one impact: one after the "
                        "other may leave other velocities");
    }
}

std::string Motion::EventDriven::advice_on_kinks() const {
  if (expansion_.switches() == 0 || expansion_.constraints() == 0) return "";
  return "; a contact with a kink is written as two, y >= x and y >= -x for y >= abs(x)";
}

std::string Motion::EventDriven::obstacle_ahead(const std::vector<Index>& contacts,
                                                const std::vector<Index>& switches) {
  if (!with_kinks(contacts, switches).empty())
    return "neither side of a kink of f goes on alone" + advice_on_kinks();
  State ahead = state;
  const double step = time_ahead(state);
  ahead.t += step;
  ahead.q += step * state.v;
  try {
    system.inertia(ahead);
    system.constraint_rates(ahead);
  } catch (const convex::InvalidInput& error) {
    return error.what();
  }
  if (!undefined_beyond_.empty())
    return "an expression changes its branch, and of those beyond it none goes on: " + undefined_beyond_;
  return "no branch of an expression such as |x| or sign(x) at x = 0 goes on; the motion slides along the "
         "place where it changes, as with dry friction" +
         advice_on_kinks();
}

void Motion::EventDriven::note_behind() {
  behind_.reset();
  if (expansion_.switches() == 0) return;
  const Index m = expansion_.constraints();
  behind_ = Behind{expansion_.lagrangian(), expansion_.momentum(), Vector(m), Vector(m),
                   expansion_.roundings_so_far()};
  for (Index a = 0; a < m; ++a) {
    behind_->f[a] = expansion_.f(a);
    behind_->rate[a] = expansion_.rate(a);
  }
}

}  // namespace mechanics::inline motions
