#include "convex/operations/line_supremum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "convex/composite/work_limit.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"

namespace convex::inline operations {
namespace {

using Rank = std::int64_t;

/// The place of a double among all in their order; that of 0 is 0, and neighbours differ by 1.
Rank rank_of(double x) {
  const Rank bits = std::bit_cast<Rank>(std::abs(x));
  return std::signbit(x) ? -bits : bits;
}

double double_of(Rank rank) {
  const double size = std::bit_cast<double>(rank < 0 ? -rank : rank);
  return rank < 0 ? -size : size;
}

/// Products with larger numbers may leave the range of doubles.
constexpr double farthest = 0x1p900;

/// The root of the rounding of a double near 1: a maximum moves its value by a rounding over so many ranks.
constexpr Rank first_step = Rank{1} << 26;
/// Steps that look for lower values on both sides grow by this; none spans more than a sixteenth of all
/// doubles.
constexpr Rank growth = 16, largest_step = Rank{1} << 58;

/// A step takes so much of the wider of the two intervals beside the best point: golden section.
constexpr double section = 0.381966011250105152;
constexpr int most_sections = 200;

/// What is left is nothing beside so many roundings of the terms.
constexpr double roundings = 8;

struct Sample {
  Rank rank = 0;
  double x = 0, value = 0;  ///< φ(x), -inf outside the domain
  double error = 0;
};

class Line {
 public:
  Line(const Function& f, double v) : f_(f), v_(v) {
    const auto domain = domain_of_one(f);
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
    const Value f_x = f_.evaluate(Vector::Constant(1, x));
    WorkLimit::count();
    Sample made{rank, x, v_ * x - f_x.value, 0};
    made.error = f_x.error + roundings * unit_roundoff * (std::abs(v_ * x) + std::abs(f_x.value));
    if (f_x.value == infinity) made.error = 0;
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
    if (made.value > samples_[best_].value) best_ = at;
    return true;
  }

  const Sample& best() const { return samples_[best_]; }
  const Sample& end(bool right) const { return right ? samples_.back() : samples_.front(); }
  /// Is φ lower at the outermost sample beyond the errors?
  bool falls(bool right) const { return end(right).value + end(right).error < best().value - best().error; }

  /// By how much φ may exceed that of the best point between it and its neighbour on a side.
  double above(bool right) const {
    const Sample* outer = beside(right, 1);
    if (!outer) return best().rank == end_of_domain_[right] ? best().error : infinity;
    const double width = std::abs(outer->x - best().x);
    double most = infinity;
    if (const Sample* inner = beside(!right, 1)) most = rise(*inner, best(), width);
    const Sample* next = beside(right, 2);
    if (next && std::isfinite(outer->value))
      most = std::min(most, outer->value - best().value + rise(*next, *outer, width));
    return std::max(most, 0.0) + best().error;
  }
  /// The rank between the best point and its neighbour on a side to be looked at; none between adjacent ones.
  std::optional<Rank> between(bool right) const {
    const Sample* outer = beside(right, 1);
    const Rank gap = outer ? outer->rank - best().rank : 0;
    if (gap >= -1 && gap <= 1) return std::nullopt;
    const Rank step = static_cast<Rank>(section * static_cast<double>(gap));
    return best().rank + (step != 0 ? step : (gap > 0 ? 1 : -1));
  }
  Rank width(bool right) const {
    const Sample* outer = beside(right, 1);
    return outer ? std::abs(outer->rank - best().rank) : 0;
  }

 private:
  const Sample* beside(bool right, std::size_t steps) const {
    if (right) return best_ + steps < samples_.size() ? &samples_[best_ + steps] : nullptr;
    return best_ >= steps ? &samples_[best_ - steps] : nullptr;
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

  const Function& f_;
  double v_;
  std::optional<Rank> end_of_domain_[2];  ///< on the left, on the right
  std::vector<Sample> samples_;           ///< by rank
  std::size_t best_ = 0;
};

}  // namespace

std::optional<LineSupremum> line_supremum(const Function& f, double v, double start) {
  Line line(f, v);
  if (!(std::abs(start) <= farthest)) return std::nullopt;
  if (!line.look_at(rank_of(line.into_domain(start))) || line.best().value == -infinity) return std::nullopt;
  for (const bool right : {false, true})
    for (Rank step = first_step; !line.falls(right) && !(line.is_at_last(right) && line.ends(right));
         step = std::min(growth * step, largest_step)) {
      if (line.is_at_last(right) || WorkLimit::passed()) return std::nullopt;
      if (!line.look_at(line.beyond(right, step))) return std::nullopt;
    }
  const double rounding = 2;  // both values of a chord have theirs
  for (int k = 0; k < most_sections && !WorkLimit::passed(); ++k) {
    const double enough = rounding * line.best().error, left = line.above(false), right = line.above(true);
    if (std::max(left, right) <= enough) break;
    // The wider interval in ranks, of those that leave more than rounding.
    const bool to_right = right > enough && (left <= enough || line.width(true) >= line.width(false));
    auto rank = line.between(to_right);
    if (!rank) rank = line.between(!to_right);
    if (!rank) break;
    if (!line.look_at(*rank)) return std::nullopt;
  }
  const double error = std::max(line.above(false), line.above(true));
  if (!std::isfinite(error)) return std::nullopt;
  return LineSupremum{line.best().x, {line.best().value, error}};
}

}  // namespace convex::inline operations
