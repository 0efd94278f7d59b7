#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/root_bracket.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/subdifferential_rules.hpp"

namespace convex::inline sets::subgradients {
namespace {

/// Slopes of the two parts that are as near as this, as a part of their size, are one. What is told is
/// between them, or follows from them.
constexpr double agreement = 1e-12;

/// The fraction of least denominator within `radius` of a number: the convergents of its continued fraction,
/// the last one shortened.
Fraction simplest_within(const Fraction& value, const Fraction& radius) {
  Fraction low = value - radius, high = value + radius;
  if (sign(low) <= 0 && sign(high) >= 0) return Fraction{};
  if (sign(high) < 0) return -simplest_within(-value, radius);
  const Integer whole = truncated_quotient(low.numerator, low.denominator);
  const Fraction floor{whole, 1}, next = floor + Fraction{1};
  if (low == floor) return floor;
  if (!(high < next)) return next;
  // Between two whole numbers: 1 over the simplest between the reciprocals of what is left.
  const Fraction above = Fraction{1} / (low - floor), below = Fraction{1} / (high - floor), half{1, 2};
  return floor + Fraction{1} / simplest_within((above + below) * half, (above - below) * half);
}

/// The fractions of least denominators within a part 1e-9 of doubles: where corners lie, most often.
Fractions simplest_near(const Vector& u) {
  constexpr double within = 1e-9;
  const double size = std::max(1.0, u.cwiseAbs().maxCoeff());
  Fractions made;
  for (const double entry : u) made.push_back(simplest_within(fraction(entry), fraction(within * size)));
  return made;
}

Vector point_of(const Subdifferential& set) { return nearest(set.polyhedron->vertices.front()); }

bool agree(const Vector& a, const Vector& b) {
  return (a - b).norm() <= agreement * std::max(a.norm(), b.norm());
}

/// ∂f(u) and ∂g(x - u).
struct Shares {
  Subdifferential first, second;
};

class Sharing {
 public:
  Sharing(const Call& f, const ExactGram& W, const Fractions& x)
      : f_(f), W_(W), x_(x), parts_(ExactArguments(f, x.size()).calls()) {}

  Subdifferential subdifferential() {
    find_covector();
    std::vector<Fractions> shares{Fractions(x_.size()), x_};
    for (const bool is_first : {true, false})
      if (const auto u = point_with_covector(is_first)) {
        const Fractions corner = simplest_near(*u), point = fractions(*u);
        shares.push_back(is_first ? corner : difference(x_, corner));
        points_.push_back(is_first ? point : difference(x_, point));
      }
    for (const Fractions& u : shares)
      if (const auto sets = at(u))
        if (auto common = common_of(*sets)) return *std::move(common);
    if (x_.size() == 1) {
      points_.insert(points_.end(), shares.begin(), shares.end());
      points_.push_back({x_[0] * Fraction{1, 2}});
      if (auto common = on_line()) return *std::move(common);
    }
    for (const Fractions& u : points_)
      if (const auto sets = at(u))
        if (auto common = common_to_rounding(*sets)) return *std::move(common);
    throw InvalidInput(f_.name +
                       ": no rule gives its subdifferential at this point as a set: doubles do not find "
                       "where its parts share x to rounding");
  }

 private:
  /// A subgradient at x, as doubles find it.
  void find_covector() {
    try {
      v_ = make_function(f_, {rounded(W_)}).subgradient(nearest(x_));
      if (v_ && !v_->allFinite()) v_.reset();
    } catch (const InvalidInput&) {
      v_.reset();
    }
  }

  /// Where a part has the covector, the gradient of its conjugate; of a corner whose subgradients have it
  /// inside, the corner.
  std::optional<Vector> point_with_covector(bool is_first) const {
    if (!v_) return std::nullopt;
    try {
      const auto u = make_function(*parts_[is_first ? 0 : 1], {rounded(W_)}).conjugate().subgradient(*v_);
      return u && u->allFinite() ? u : std::nullopt;
    } catch (const InvalidInput&) {
      return std::nullopt;
    }
  }

  /// None where a part is infinite, has a vertical slope or one beyond doubles, or no rule.
  std::optional<Shares> at(const Fractions& u) const {
    try {
      Shares sets{convex::subdifferential(*parts_[0], W_, u),
                  convex::subdifferential(*parts_[1], W_, difference(x_, u))};
      if (sets.first.is_empty() || sets.second.is_empty()) return std::nullopt;
      return sets;
    } catch (const InvalidInput&) {
      return std::nullopt;
    }
  }

  /// ∂f(u) ∩ ∂g(x - u) where it is not empty for certain; a gradient that is rounded, where it lies in a
  /// corner's subgradients.
  std::optional<Subdifferential> common_of(const Shares& sets) const {
    const auto& [first, second] = sets;
    if (first.polyhedron && second.polyhedron && first.is_exact && second.is_exact) {
      Subdifferential common = intersection(first, second);
      return common.is_empty() ? std::nullopt : std::optional(std::move(common));
    }
    if (first.is_single() && second.is_single()) return std::nullopt;
    for (const auto& [one, corner] : {std::pair{&first, &second}, std::pair{&second, &first}}) {
      if (!one->is_single()) continue;
      const Vector v = point_of(*one);
      if (!agree(corner->projection(v, Metric::identity(v.size())), v)) return std::nullopt;
      return single(one->polyhedron->vertices.front(), one->is_exact && corner->is_exact);
    }
    const auto is_near = [&](const Subdifferential& set) {
      return (set.projection(*v_, Metric::identity(v_->size())) - *v_).norm() <=
             membership_tolerance * std::max(1.0, v_->norm());
    };
    if (!v_ || !is_near(first) || !is_near(second)) return std::nullopt;
    return intersection(first, second);
  }

  /// At a share of doubles: a gradient in the other part's subgradients, or beside them by its rounding.
  std::optional<Subdifferential> common_to_rounding(const Shares& sets) const {
    for (const auto& [one, other] :
         {std::pair{&sets.first, &sets.second}, std::pair{&sets.second, &sets.first}}) {
      if (!one->is_single()) continue;
      const Vector v = point_of(*one);
      if (agree(other->projection(v, Metric::identity(v.size())), v)) return single(fractions(v), false);
    }
    return std::nullopt;
  }

  /// The least and the greatest slope of a part.
  struct Slopes {
    double low = 0, high = 0;
    explicit Slopes(const Subdifferential& set)
        : low(-set.support({-Fraction{1}})), high(set.support({Fraction{1}})) {}
  };

  /// A share of one entry, a double beside a fraction: u itself, or how far it is from a double near it.
  Fractions share(double u, const Fraction& beside) const { return {beside + fraction(u)}; }

  /// How far the slope of f at u is above that of g at x - u: an increasing function of u, 0 where they meet.
  /// Beyond `inside`, where both have slopes, one that has none has come to the end of its domain or of
  /// doubles.
  double excess(double u, const Fraction& beside, double inside) const {
    const auto sets = at(share(u, beside));
    if (!sets) return u > inside ? infinity : -infinity;
    const Slopes f(sets->first), g(sets->second);
    return f.low > g.high ? f.low - g.high : std::min(f.high - g.low, 0.0);
  }

  /// Of one entry: u between neighbours among doubles, by bisection; where these are too far apart, u less
  /// one of them between such neighbours.
  std::optional<Subdifferential> on_line() const {
    for (const Fractions& point : points_) {
      const double start = nearest_double(point[0]);
      if (!at({fraction(start)})) continue;
      const auto ends = around(start);
      if (!ends) return std::nullopt;
      if (auto common = between(*ends, Fraction{})) return common;
      const double left = ends->left, right = ends->right;
      const Ends finer{0, ends->of_left, right - left, ends->of_right};
      return between(bisected(finer, fraction(left), 0), fraction(left));
    }
    return std::nullopt;
  }

  /// Two doubles, and the excess there: below 0 at the left and above 0 at the right one, or 0 at both, then
  /// equal.
  struct Ends {
    double left = 0, of_left = 0, right = 0, of_right = 0;
  };

  std::optional<Ends> around(double start) const {
    const double first = excess(start, Fraction{}, start);
    if (first == 0) return Ends{start, 0, start, 0};
    const Rank largest = rank_of(std::numeric_limits<double>::max()), from = rank_of(start);
    double near = start, of_near = first;
    const Rank last = first > 0 ? -largest : largest;
    for (Rank to = from, step = 1; to != last; step = std::min(2 * step, largest / 2)) {
      const bool is_last = first > 0 ? to < step - largest : to > largest - step;
      to = is_last ? last : first > 0 ? to - step : to + step;
      const double next = double_of(to), of_next = excess(next, Fraction{}, start);
      if (of_next == 0) return Ends{next, 0, next, 0};
      if ((of_next > 0) != (first > 0))
        return bisected(first > 0 ? Ends{next, of_next, near, of_near} : Ends{near, of_near, next, of_next},
                        Fraction{}, start);
      near = next;
      of_near = of_next;
    }
    return std::nullopt;
  }

  Ends bisected(Ends ends, const Fraction& beside, double inside) const {
    RootBracket root(ends.left, ends.of_left, ends.right, ends.of_right);
    while (!root.is_closed()) {
      const double u = root.next(), value = excess(u, beside, inside);
      if (value == 0) return {u, 0, u, 0};
      if (value < 0) {
        ends.left = u;
        ends.of_left = value;
      } else {
        ends.right = u;
        ends.of_right = value;
      }
      root.take(u, value);
    }
    return ends;
  }

  /// The slopes have a number in common at a double, as doubles tell them.
  std::optional<Subdifferential> common_on_line(const Shares& sets) const {
    if (auto common = common_of(sets)) return common;
    const Slopes f(sets.first), g(sets.second);
    const double v = std::clamp(std::max(f.low, g.low), f.low, f.high);
    return single({fraction(v)}, false);
  }

  /// f's slope rises over a bracket, and g's falls: what they have in common is between both.
  std::optional<Subdifferential> between(const Ends& ends, const Fraction& beside) const {
    const auto a = at(share(ends.left, beside)), b = at(share(ends.right, beside));
    if (ends.left == ends.right && a) return common_on_line(*a);
    if (!a || !b) return std::nullopt;
    const Slopes f_left(a->first), g_left(a->second), f_right(b->first), g_right(b->second);
    const double low = std::max(f_left.high, g_right.high), high = std::min(f_right.low, g_left.low);
    if (!(std::abs(high - low) <= agreement * std::min(std::abs(low), std::abs(high)))) return std::nullopt;
    const double below = g_left.low - f_left.high, above = f_right.low - g_right.high;
    const double crossing = f_left.high + (f_right.low - f_left.high) * (below / (below + above));
    return single({fraction(std::clamp(crossing, std::min(low, high), std::max(low, high)))}, false);
  }

  const Call& f_;
  const ExactGram& W_;
  const Fractions& x_;
  const std::vector<const Call*> parts_;
  std::optional<Vector> v_;
  std::vector<Fractions> points_;  ///< near the share, as doubles find it
};

}  // namespace

Subdifferential of_inf_convolution(const Call& f, const ExactGram& W, const Fractions& x) {
  return Sharing(f, W, x).subdifferential();
}

}  // namespace convex::inline sets::subgradients
