#include <algorithm>
#include <cmath>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/polynomial_root.hpp"
#include "mechanics/motion/terms.hpp"
#include "mechanics/number_text.hpp"

/// What is said of impacts whose times rounding leaves open.
namespace mechanics::inline motions {
namespace {

/// A product of gradients that do not move each other is left by so many roundings of their lengths.
constexpr double roundings_of_product = 64;

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
    double w = std::min(least, most);
    while (w < most && std::abs(polynomial_at(c, tau + sense * w) - there) <= rounding)
      w = std::min(2 * w, most);
    return w;
  };
  return std::max(width(-1, tau), width(1, ahead));
}

}  // namespace

/// Of a contact that closes. Without t, its terms are about as large as those of its differential.
double Motion::EventDriven::rounding_of_f(Index a) {
  if (!expansion_.uses_time()) return epsilon * expansion_.position_scale(a);
  return epsilon * (expansion_.magnitude_of_constraint(a) + std::abs(state.t * expansion_.rate(a)));
}

/// Near a tangency f falls so slowly through 0 that its rounding leaves the time of the impact uncertain. The
/// last bounces before rest do so too: their end is told with its own error.
void Motion::EventDriven::tell_blur(const std::vector<Index>& closing) {
  for (const Index a : closing) {
    const auto k = static_cast<std::size_t>(a);
    const bool has_known_end = std::isfinite(history_[k].end_error());
    if (is_blurred_[k] || has_known_end) continue;
    const std::span<const double> c = coefficients(done.f, a);
    const double rounding = rounding_of_f(a) + epsilon * sum_of_terms(c, done.length);
    const double by_slope = rounding / -expansion_.rate(a);
    // The width of a zero of order p is about 2 p times that.
    if (!(2 * most_coefficients * by_slope > options.tolerance * clock())) continue;
    const double blur =
        std::max(by_slope, width_of_zero(c, done.length, 2 * step_ahead_, rounding, by_slope));
    if (!(blur > options.tolerance * clock())) continue;
    is_blurred_[k] = true;
    history_[k].doubt(blur, -expansion_.rate(a));
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

}  // namespace mechanics::inline motions
