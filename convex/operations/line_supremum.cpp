#include "convex/operations/line_supremum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "convex/gamma0/node.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/order_of_doubles.hpp"

namespace convex::inline operations {
namespace {

/// Products with larger numbers may leave the range of doubles.
constexpr double farthest = 0x1p900;

/// The root of the rounding of a double near 1: a maximum moves its value by a rounding over so many ranks.
constexpr Rank first_rank_step = Rank{1} << 26;
/// Steps that look for lower values on both sides grow by this; none spans more than a sixteenth of all
/// doubles.
constexpr Rank growth = 16, largest_step = Rank{1} << 58;

/// A look takes so much of the interval that leaves most, from its greater end: golden section.
constexpr double section = 0.381966011250105152;
constexpr int most_sections = 200;

/// What is left is nothing beside so many roundings of the terms.
constexpr double roundings_of_terms = 8;

struct Sample {
  Rank rank = 0;
  double x = 0, value = 0;  ///< φ(x), -inf outside the domain
  double error = 0;
};

class Line {
 public:
  Line(const LineValues& f, const std::optional<Interval>& domain, double v) : f_(f), v_(v) {
    if (!domain) return;
    // A set takes in points that miss it by its tolerance: they are not looked at.
    if (domain->low >= -farthest) end_of_domain_[0] = rank_of(domain->low);
    if (domain->high <= farthest) end_of_domain_[1] = rank_of(domain->high);
  }

  double into_domain(double x) const {
    const auto& [low, high] = end_of_domain_;
    if (low && rank_of(x) < *low) return double_of(*low);
    return high && rank_of(x) > *high ? double_of(*high) : x;
  }

  /// The rank so far on a side, or that of the end of the domain.
  Rank beyond(bool right, Rank step) const {
    const Rank from = end(right).rank;
    return right ? std::min(from + step, last(right)) : std::max(from - step, last(right));
  }
  bool is_at_last(bool right) const { return end(right).rank == last(right); }
  bool ends(bool right) const { return end_of_domain_[right].has_value(); }

  /// False where φ is not known there.
  bool look_at(Rank rank) {
    const double x = double_of(rank);
    const Value f_x = f_(x);
    WorkLimit::count();
    Sample made{rank, x, v_ * x - f_x.value, 0};
    made.error = f_x.error + roundings_of_terms * unit_roundoff * (std::abs(v_ * x) + std::abs(f_x.value));
    if (f_x.value == infinity && f_x.error == 0) made.error = 0;
    if (!std::isfinite(made.error) || (!std::isfinite(made.value) && f_x.value != infinity)) return false;
    const auto place = std::lower_bound(samples_.begin(), samples_.end(), rank,
                                        [](const Sample& s, Rank r) { return s.rank < r; });
    if (place != samples_.end() && place->rank == rank) return true;
    const auto at = static_cast<std::size_t>(place - samples_.begin());
    samples_.insert(place, made);
    if (samples_.size() == 1) {
      best_ = 0;
      return true;
    }
    if (at <= best_) ++best_;
    if (made.value - made.error > samples_[best_].value - samples_[best_].error) best_ = at;
    return true;
  }

  const Sample& best() const { return samples_[best_]; }
  const Sample& end(bool right) const { return right ? samples_.back() : samples_.front(); }
  /// Is φ lower at the outermost sample beyond the errors?
  bool falls(bool right) const { return is_lower(end(right)); }

  Interval around() const {
    const auto [first, last] = not_lower();
    return {samples_[first].x, samples_[last].x};
  }

  /// By how much φ may exceed that of the best point, and where a look tells most; no rank between doubles
  /// that are neighbours.
  struct Open {
    double excess = 0;
    std::optional<Rank> look;
  };
  /// Beyond the nearest sample on each side that is lower for certain, φ is lower. Samples within the errors
  /// of the best may lie between: each of the intervals may hide the maximum.
  Open open() const {
    const auto [first, last] = not_lower();
    Open found{best().error, std::nullopt};
    double most = -infinity;
    for (std::size_t i = first; i < last; ++i) {
      const double excess = excess_between(i) + best().error;
      found.excess = std::max(found.excess, excess);
      if (!(excess > most) || samples_[i + 1].rank - samples_[i].rank < 2) continue;
      most = excess;
      found.look = inside(i);
    }
    return found;
  }

 private:
  /// From the nearest sample on the left that is lower for certain to that on the right, or to the last.
  std::pair<std::size_t, std::size_t> not_lower() const {
    std::size_t first = best_, last = best_;
    while (first > 0 && !is_lower(samples_[first])) --first;
    while (last + 1 < samples_.size() && !is_lower(samples_[last])) ++last;
    return {first, last};
  }
  bool is_lower(const Sample& s) const { return s.value + s.error < best().value - best().error; }

  /// By how much φ may exceed that of the best point between the i-th sample and the next.
  double excess_between(std::size_t i) const {
    const Sample &left = samples_[i], &right = samples_[i + 1];
    const double width = right.x - left.x;
    double most = infinity;
    if (i > 0 && std::isfinite(left.value))
      most = left.value - best().value + rise(samples_[i - 1], left, width);
    if (i + 2 < samples_.size() && std::isfinite(right.value))
      most = std::min(most, right.value - best().value + rise(samples_[i + 2], right, width));
    return std::max(most, 0.0);
  }
  /// Nearer to the greater of both ends.
  Rank inside(std::size_t i) const {
    const Sample &left = samples_[i], &right = samples_[i + 1];
    const Rank step =
        std::max<Rank>(1, static_cast<Rank>(section * static_cast<double>(right.rank - left.rank)));
    return left.value >= right.value ? left.rank + step : right.rank - step;
  }
  /// The chord from a to b, drawn on beyond b by `width`: φ(b) plus this is no less than φ there.
  static double rise(const Sample& a, const Sample& b, double width) {
    const double up = b.value + b.error - (a.value - a.error);
    if (!std::isfinite(up)) return infinity;
    return up <= 0 ? b.error : up * (width / std::abs(b.x - a.x)) + b.error;
  }

  Rank last(bool right) const {
    const Rank far = rank_of(farthest);
    return end_of_domain_[right].value_or(right ? far : -far);
  }

  const LineValues& f_;
  double v_;
  std::optional<Rank> end_of_domain_[2];  ///< on the left, on the right
  std::vector<Sample> samples_;           ///< by rank
  std::size_t best_ = 0;
};

}  // namespace

namespace {

std::optional<LineSupremum> supremum_of(const LineValues& f, const std::optional<Interval>& domain, double v,
                                        double start) {
  Line line(f, domain, v);
  if (!(std::abs(start) <= farthest)) return std::nullopt;
  if (!line.look_at(rank_of(line.into_domain(start))) || line.best().value == -infinity) return std::nullopt;
  const auto lower_bound = [&] {
    return LineSupremum{line.best().x, {line.best().value - line.best().error, infinity}};
  };
  for (const bool right : {false, true}) {
    Rank most = largest_step;
    for (Rank step = first_rank_step; !line.falls(right) && !(line.is_at_last(right) && line.ends(right));
         step = std::min(growth * step, most)) {
      if (line.is_at_last(right) || WorkLimit::passed()) return lower_bound();
      // What is not known far out, as e^x beyond doubles, may be nearer.
      for (; !line.look_at(line.beyond(right, step)); most = step /= growth)
        if (step <= first_rank_step) return lower_bound();
    }
  }
  // A chord through values within rounding of each other rises by both errors, and more where drawn on.
  const double rounding = 8;
  constexpr double smallest = std::numeric_limits<double>::min();  // below, doubles lose their digits
  Line::Open open = line.open();
  for (int k = 0; k < most_sections && open.look && !WorkLimit::passed(); ++k) {
    if (open.excess <= std::max(rounding * line.best().error, smallest)) break;
    if (!line.look_at(*open.look)) return lower_bound();
    open = line.open();
  }
  if (!std::isfinite(open.excess)) return lower_bound();
  return LineSupremum{line.best().x, {line.best().value, open.excess}, line.around()};
}

}  // namespace

std::optional<LineSupremum> line_supremum(const Function& f, double v, double start) {
  return supremum_of([&](double x) { return f.evaluate(Vector::Constant(1, x)); }, domain_of_one(f), v,
                     start);
}

Value least_on_line(const LineValues& f, double start) {
  const auto found = supremum_of(f, std::nullopt, 0, start);
  return found ? Value{-found->value.value, found->value.error} : Value{infinity, infinity};
}

}  // namespace convex::inline operations
