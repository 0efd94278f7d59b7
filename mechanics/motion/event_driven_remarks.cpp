#include <algorithm>
#include <cmath>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/number_text.hpp"

/// What is said of impacts whose times rounding leaves open.
namespace mechanics::inline motions {
namespace {

/// A product of gradients that do not move each other is left by so many roundings of their lengths.
constexpr double roundings_of_product = 64;

}  // namespace

/// Near a tangency f falls so slowly through 0 that its rounding leaves the time of the impact uncertain. The
/// last bounces before rest do so too: their end is told with its own error.
void Motion::EventDriven::tell_blur(const std::vector<Index>& closing) {
  for (const Index a : closing) {
    const auto k = static_cast<std::size_t>(a);
    const double blur = rounding_of_f(a) / -expansion_.rate(a);
    const bool has_known_end = std::isfinite(history_[k].end_error());
    if (is_blurred_[k] || has_known_end || !(blur > options.tolerance * clock())) continue;
    is_blurred_[k] = true;
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
