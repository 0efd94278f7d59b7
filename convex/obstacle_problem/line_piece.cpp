#include "convex/obstacle_problem/line_piece.hpp"

#include <cmath>

#include "convex/interval_arithmetic.hpp"

namespace convex::inline obstacle_problem {
namespace {

Interval exactly(double x) { return interval_at(x); }

Interval power_of(const Interval& t, std::size_t exponent) {
  Interval power = exactly(1);
  for (std::size_t j = 0; j < exponent; ++j) power = power * t;
  return {0, std::max(0.0, power.high)};
}

bool is_bounded(const Interval& a) { return std::isfinite(a.low) && std::isfinite(a.high); }

}  // namespace

Interval EnclosedWeight::operator()(const Interval& r) const {
  return power_ == 0 ? exactly(1) : power_ == 1 ? r : square(r);
}

Interval EnclosedWeight::resistance(const Interval& a, const Interval& t) const {
  if (power_ == 0) return t;
  if (power_ == 2) return t / (a * (a + t));
  return increasing([](double x) { return std::log1p(x); }, t / a);
}

double EnclosedWeight::resistance(double a, double t) const {
  return power_ == 0 ? t : power_ == 1 ? std::log1p(t / a) : t / (a * (a + t));
}

/// By (a + t) M'' + k M' = (a + t) h, and at the centre t M'' + k M' = t h.
void LinePieceEnclosure::integrate(const EnclosedWeight& w) {
  const auto k = static_cast<double>(w.power());
  q_.fill({});
  if (h.mass) {
    rest_ = {};
    return;
  }
  rest_ = h.c[h.degree];
  for (std::size_t m = 0; m < h.degree; ++m) {
    const auto n = static_cast<double>(m);
    if (w.power() == 0)
      q_[m + 2] = h.c[m] / exactly((n + 1) * (n + 2));
    else if (is_centre)
      q_[m + 2] = h.c[m] / exactly((n + 2) * (n + 1 + k));
    else
      q_[m + 2] = (a * h.c[m] + (m > 0 ? h.c[m - 1] : Interval{}) - exactly((n + 1) * (n + k)) * q_[m + 1]) /
                  (a * exactly((n + 1) * (n + 2)));
  }
  if (w.power() == 0 || is_centre || h.degree == 0) return;
  // What the series leaves of the equation is σ t^degree; so it is M for h + σ t^degree/(a + t).
  const auto n = static_cast<double>(h.degree);
  const Interval left = exactly((n + 1) * (n + k)) * q_[h.degree + 1] - h.c[h.degree - 1];
  rest_ = rest_ - left / Interval{a.low, moved_up(a.high + width.high)};
}

double LinePieceEnclosure::remainder() const {
  if (h.mass) return moved_up(largest_size(*h.mass) * width.high);
  const auto n = static_cast<double>(h.degree);
  return moved_up(largest_size(rest_) * std::pow(width.high, n + 2) / ((n + 1) * (n + 2)), 16);
}

bool LinePieceEnclosure::is_finite() const {
  bool all = is_bounded(rest_) && (!h.mass || is_bounded(*h.mass));
  for (const Interval& one : q_) all = all && is_bounded(one);
  return all;
}

double LinePieceEnclosure::sag(double length) const {
  if (h.mass) return moved_up(2 * largest_size(*h.mass) * length, 8);
  const Interval range = h_range();
  // -(w e')' = w h⁻ with e = 0 at the ends has e <= ∫ w h⁻ R(τ, b) <= h⁻ T²/2, for w grows.
  return moved_up(std::max(0.0, -range.low) * length * length / 2, 8);
}

Interval LinePieceEnclosure::h_range() const {
  if (h.mass) return h.c[0];
  const Interval t{0, width.high};
  Interval sum = h.c[h.degree];
  for (std::size_t j = h.degree; j-- > 0;) sum = sum * t + h.c[j];
  return sum;
}

// The kernels of M and of its flux, w(τ) R(τ, t) <= t - τ and w <= w(a + t), bound what is not a number but a
// function.

Interval LinePieceEnclosure::moment(const Interval& t) const {
  if (h.mass) return *h.mass * Interval{0, std::max(0.0, t.high)};
  const auto n = static_cast<double>(h.degree);
  Interval sum;
  for (std::size_t j = h.degree + 2; j-- > 2;) sum = sum * t + q_[j];
  return sum * t * t + rest_ * power_of(t, h.degree + 2) * Interval{0, moved_up(1 / ((n + 1) * (n + 2)))};
}

Interval LinePieceEnclosure::load(const EnclosedWeight& w, const Interval& t) const {
  if (h.mass) return *h.mass;
  const auto n = static_cast<double>(h.degree);
  Interval sum;
  for (std::size_t j = h.degree + 2; j-- > 2;) sum = sum * t + exactly(static_cast<double>(j)) * q_[j];
  const Interval weight = w(a + t);
  return weight * sum * t + rest_ * weight * power_of(t, h.degree + 1) * Interval{0, moved_up(1 / (n + 1))};
}

Interval LinePieceEnclosure::value(const EnclosedWeight& w, const Interval& t) const {
  return is_centre ? p - moment(t) : p + flux * w.resistance(a, t) - moment(t);
}

Interval LinePieceEnclosure::flux_at(const EnclosedWeight& w, const Interval& t) const {
  return flux - load(w, t);
}

}  // namespace convex::inline obstacle_problem
