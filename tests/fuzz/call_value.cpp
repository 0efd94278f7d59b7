#include "tests/fuzz/call_value.hpp"

#include <numeric>
#include <string>

namespace fuzz {
namespace {

using convex::Argument;
using convex::Call;
using convex::NamedArgument;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

thread_local Real slack_of_sets = rounded;

std::optional<CallValue> call_value(const Call& f, const Point& x);

Real number(const Call& call, std::size_t index, Real fallback) {
  if (index >= call.arguments.size()) return fallback;
  const double* given = std::get_if<double>(&call.arguments[index].value);
  return given ? static_cast<Real>(*given) : fallback;
}

const convex::Matrix* matrix(const Call& call, std::size_t index) {
  return index < call.arguments.size() ? std::get_if<convex::Matrix>(&call.arguments[index].value) : nullptr;
}

/// A vector, or a number for one with equal entries.
Point vector(const Call& call, std::size_t index, std::size_t n, Real fallback) {
  if (index < call.arguments.size())
    if (const auto* given = std::get_if<convex::Vector>(&call.arguments[index].value))
      return Point(given->begin(), given->end());
  return Point(n, number(call, index, fallback));
}

const Call& nested(const Call& call, std::size_t index) {
  return *std::get<std::shared_ptr<const Call>>(call.arguments[index].value);
}

Real norm(const Point& x) {
  Real sum = 0;
  for (const Real v : x) sum += v * v;
  return std::sqrt(sum);
}

/// A·x + b, and the size of what it is a sum of.
Point affine(const convex::Matrix& A, const Point& x, const Point& b, Real& size) {
  Point image(static_cast<std::size_t>(A.rows()));
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = i < b.size() ? b[i] : 0;
    size = std::max(size, std::abs(image[i]));
    for (std::size_t j = 0; j < x.size(); ++j) {
      const Real part = A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * x[j];
      image[i] += part;
      size = std::max(size, std::abs(part));
    }
  }
  return image;
}

CallValue constant(Real value) { return {value, true, std::abs(value)}; }

CallValue allowed(bool inside) { return {inside ? 0 : infinity, true, 0}; }

/// By how much x misses a set of the language, relative to what is compared; none when it is not known here.
std::optional<CallValue> set_value(const Call& set, const Point& x) {
  const std::size_t n = x.size();
  const auto within = [](Real a, Real b, Real size) { return allowed(a - b <= slack_of_sets * size); };
  const Real scale = norm(x);
  if (set.name == "box" || set.name == "orthant" || set.name == "ball_inf") {
    const bool ball = set.name == "ball_inf", orthant = set.name == "orthant";
    const Point low = orthant ? Point(n, 0) : vector(set, 0, n, ball ? 1 : -infinity);
    const Point high = orthant ? Point(n, infinity) : ball ? low : vector(set, 1, n, infinity);
    for (std::size_t i = 0; i < n; ++i) {
      const Real down = ball ? -low[i] : low[i];
      const auto size = [&](Real end) { return scale + (std::isfinite(end) ? std::abs(end) : 0); };
      if (x[i] < down - slack_of_sets * size(down) || x[i] > high[i] + slack_of_sets * size(high[i]))
        return allowed(false);
    }
    return allowed(true);
  }
  if (set.name == "ball2") {
    const Real radius = number(set, 0, 1);
    const Point centre = vector(set, 1, n, 0);
    Point off = x;
    for (std::size_t i = 0; i < n; ++i) off[i] -= centre[i];
    return within(norm(off), radius, scale + radius + norm(centre));
  }
  if (set.name == "ball1") {
    Real sum = 0;
    for (const Real v : x) sum += std::abs(v);
    return within(sum, number(set, 0, 1), sum);
  }
  if (set.name == "simplex") {
    const Real total = number(set, 0, 1);
    Real sum = 0;
    for (const Real v : x) {
      if (v < -slack_of_sets * (scale + total)) return allowed(false);
      sum += v;
    }
    return within(std::abs(sum - total), 0, scale + total);
  }
  if (set.name == "halfspace" || set.name == "hyperplane") {
    const Point a = vector(set, 0, n, 0);
    const Real b = number(set, 1, 0);
    Real product = 0, size = std::abs(b);
    for (std::size_t i = 0; i < n; ++i) {
      product += a[i] * x[i];
      size += std::abs(a[i] * x[i]);
    }
    return within(set.name == "halfspace" ? product : std::abs(product - b), set.name == "halfspace" ? b : 0,
                  size);
  }
  if (set.name == "polyhedron" || set.name == "affine") {
    const convex::Matrix* A = matrix(set, 0);
    if (!A) return std::nullopt;
    Real size = 0;
    const Point b = vector(set, 1, static_cast<std::size_t>(A->rows()), 0), image = affine(*A, x, {}, size);
    for (std::size_t i = 0; i < image.size(); ++i) {
      const Real off = image[i] - b[i];
      if ((set.name == "affine" ? std::abs(off) : off) > slack_of_sets * (size + std::abs(b[i])))
        return allowed(false);
    }
    return allowed(true);
  }
  if (set.name == "second_order_cone") return within(norm(Point(x.begin(), x.end() - 1)), x.back(), scale);
  if (set.name == "point") {
    const Point p = vector(set, 0, n, 0);
    for (std::size_t i = 0; i < n; ++i)
      if (std::abs(x[i] - p[i]) > slack_of_sets * (scale + std::abs(p[i]))) return allowed(false);
    return allowed(true);
  }
  if (set.name == "intersection") {
    for (std::size_t k = 0; k < set.arguments.size(); ++k) {
      const auto part = set_value(nested(set, k), x);
      if (!part || part->value > 0) return part;
    }
    return allowed(true);
  }
  if (set.name == "epigraph") {
    const auto height = call_value(nested(set, 0), Point(x.begin(), x.end() - 1));
    if (!height) return std::nullopt;
    if (!std::isfinite(height->value)) return allowed(false);
    CallValue found = within(height->value, x.back(), height->size + std::abs(x.back()));
    found.exact =
        height->exact && std::abs(height->value - x.back()) > 1e-6L * (height->size + std::abs(x.back()));
    return found;
  }
  return std::nullopt;
}

/// sum over the entries of term(x_i).
template <class Term>
CallValue summed(const Point& x, const Term& term) {
  CallValue found;
  for (const Real v : x) {
    const Real part = term(v);
    found.value += part;
    found.size = std::max(found.size, std::abs(part));
  }
  return found;
}

Real xlogx(Real x) { return x > 0 ? x * std::log(x) : x < 0 ? infinity : 0; }

/// A value that rounding has put just outside [0, …) is that of 0.
Real not_negative(Real x, Real scale) { return x < 0 && x >= -slack_of_sets * scale ? 0 : x; }

std::optional<CallValue> atom_value(const Call& f, const Point& x) {
  const std::size_t n = x.size();
  const Real scale = norm(x);
  const std::string& name = f.name;
  const auto sum = [&](auto term) { return summed(x, term); };
  if (name == "zero") return constant(0);
  if (name == "constant") return constant(number(f, 0, 0));
  if (name == "hinge") return sum([](Real v) { return std::max(0.0L, 1 - v); });
  if (name == "squared_hinge") return sum([](Real v) { return v < 1 ? (1 - v) * (1 - v) : 0; });
  if (name == "entropy") return sum([&](Real v) { return xlogx(not_negative(v, scale)); });
  if (name == "binary_entropy")
    return sum(
        [&](Real v) { return xlogx(not_negative(v, scale + 1)) + xlogx(not_negative(1 - v, scale + 1)); });
  if (name == "log_barrier") return sum([](Real v) { return v > 0 ? -std::log(v) : infinity; });
  if (name == "logistic")
    return sum([](Real v) { return v > 0 ? v + std::log1p(std::exp(-v)) : std::log1p(std::exp(v)); });
  if (name == "exponential") return sum([](Real v) { return std::exp(v); });
  if (name == "inverse_power") {
    const Real q = number(f, 0, 1);
    return sum([&](Real v) { return v > 0 ? std::pow(v, -q) : infinity; });
  }
  if (name == "negative_power") {
    const Real r = number(f, 0, 0.5L);
    return sum([&](Real v) {
      v = not_negative(v, scale);
      return v >= 0 ? -std::pow(v, r) : infinity;
    });
  }
  if (name == "kullback_leibler") {
    const Real r = number(f, 0, 1);
    return sum([&](Real v) {
      v = not_negative(v, scale + r);
      return v > 0 ? v * std::log(v / r) - v + r : v < 0 ? infinity : r;
    });
  }
  if (name == "power") {
    const Real p = number(f, 0, 2);
    return sum([&](Real v) { return std::pow(std::abs(v), p); });
  }
  if (name == "norm1") {
    const Point w = vector(f, 0, n, 1);
    CallValue found;
    for (std::size_t i = 0; i < n; ++i) found.value += w[i] * std::abs(x[i]);
    found.size = found.value;
    return found;
  }
  if (name == "norm2") return constant(number(f, 0, 1) * scale);
  if (name == "squared_norm2") return constant(number(f, 0, 1) / 2 * scale * scale);
  if (name == "norm_inf") {
    Real most = 0;
    for (const Real v : x) most = std::max(most, std::abs(v));
    return constant(number(f, 0, 1) * most);
  }
  if (name == "max") return constant(*std::max_element(x.begin(), x.end()));
  if (name == "sum_largest") {
    Point sorted = x;
    std::sort(sorted.rbegin(), sorted.rend());
    const auto k = static_cast<std::size_t>(number(f, 0, 1));
    return CallValue{std::accumulate(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(k), 0.0L),
                     true, scale};
  }
  if (name == "total_variation") {
    Real total = 0;
    for (std::size_t i = 1; i < n; ++i) total += std::abs(x[i] - x[i - 1]);
    return CallValue{number(f, 0, 1) * total, true, number(f, 0, 1) * scale};
  }
  if (name == "huber") {
    const Real mu = number(f, 0, 1);
    return sum([&](Real v) { return std::abs(v) <= mu ? v * v / (2 * mu) : std::abs(v) - mu / 2; });
  }
  if (name == "elastic_net") {
    const Real one = number(f, 0, 1), two = number(f, 1, 1);
    return sum([&](Real v) { return one * std::abs(v) + two / 2 * v * v; });
  }
  if (name == "max_affine") {
    const convex::Matrix* A = matrix(f, 0);
    if (!A) return std::nullopt;
    CallValue found{-infinity, true, 0};
    const Point image = affine(*A, x, vector(f, 1, static_cast<std::size_t>(A->rows()), 0), found.size);
    found.value = *std::max_element(image.begin(), image.end());
    return found;
  }
  if (name == "linear") {
    const Point c = vector(f, 0, n, 0);
    CallValue found;
    for (std::size_t i = 0; i < n; ++i) {
      found.value += c[i] * x[i];
      found.size = std::max(found.size, std::abs(c[i] * x[i]));
    }
    return found;
  }
  if (name == "quadratic") {
    const convex::Matrix* Q = matrix(f, 0);
    if (!Q) return std::nullopt;
    CallValue found{number(f, 2, 0), true, std::abs(number(f, 2, 0))};
    const Point image = affine(*Q, x, {}, found.size), c = vector(f, 1, n, 0);
    found.size *= scale;
    for (std::size_t i = 0; i < n; ++i) {
      found.value += x[i] * (image[i] / 2 + c[i]);
      found.size = std::max(found.size, std::abs(x[i] * c[i]));
    }
    return found;
  }
  if (name == "plq") {
    const Point breaks = vector(f, 0, 1, 0);
    const convex::Matrix* rows = matrix(f, 1);
    if (!rows) return std::nullopt;
    return sum([&](Real v) {
      const auto piece =
          static_cast<Eigen::Index>(std::upper_bound(breaks.begin(), breaks.end(), v) - breaks.begin());
      if (std::isinf((*rows)(piece, 0))) return infinity;
      return v * (v * static_cast<Real>((*rows)(piece, 0)) / 2 + static_cast<Real>((*rows)(piece, 1))) +
             static_cast<Real>((*rows)(piece, 2));
    });
  }
  return std::nullopt;
}

/// min over w on the line of first(w) + second(w), for functions of one entry.
template <class Both>
std::optional<CallValue> searched(const Both& both, const std::vector<Real>& seeds) {
  bool known = true;
  Real size = 0;
  const auto at = [&](Real w) {
    const std::optional<CallValue> value = both(w);
    known = known && value;
    return value ? value->value : infinity;
  };
  const LineMinimum least = least_on_line(at, seeds);
  if (const auto value = both(least.at)) size = value->size;
  if (!known) return std::nullopt;
  return CallValue{least.value, false, size};
}

std::optional<CallValue> plus(const std::optional<CallValue>& a, const std::optional<CallValue>& b) {
  if (!a || !b) return std::nullopt;
  return CallValue{a->value + b->value, a->exact && b->exact, std::max(a->size, b->size)};
}

std::optional<CallValue> times(std::optional<CallValue> a, Real factor) {
  if (a) {
    a->value *= factor;
    a->size *= factor;
  }
  return a;
}

/// Searches inside searches are too slow: a nested one is left out.
thread_local int searching = 0;

template <class Both>
std::optional<CallValue> one_search(const Both& both, const std::vector<Real>& seeds) {
  if (searching > 0) return std::nullopt;
  ++searching;
  auto found = searched(both, seeds);
  --searching;
  return found;
}

std::optional<CallValue> call_value(const Call& f, const Point& x) {
  const std::size_t n = x.size();
  const std::string& name = f.name;
  if (name == "indicator") return set_value(nested(f, 0), x);
  if (name == "sum") {
    std::optional<CallValue> total = constant(0);
    for (std::size_t k = 0; k < f.arguments.size(); ++k) total = plus(total, call_value(nested(f, k), x));
    return total;
  }
  if (name == "pointwise_max") {
    std::optional<CallValue> most;
    for (std::size_t k = 0; k < f.arguments.size(); ++k) {
      const auto part = call_value(nested(f, k), x);
      if (!part) return std::nullopt;
      if (!most || part->value > most->value)
        most = CallValue{part->value, part->exact && (!most || most->exact),
                         std::max(part->size, most ? most->size : 0)};
      else
        most->exact = most->exact && part->exact;
    }
    return most;
  }
  if (name == "translate" || name == "dilate") {
    const Point by = vector(f, 1, n, 0);
    Point moved = x;
    Real size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      moved[i] = name == "translate" ? x[i] - by[i] : x[i] / number(f, 1, 1);
      size = std::max(size, name == "translate" ? std::abs(x[i]) + std::abs(by[i]) : 0);
    }
    auto part = call_value(nested(f, 0), moved);
    return part;
  }
  if (name == "tilt") {
    const Call linear{"linear", {f.arguments[1]}, {}};
    return plus(call_value(nested(f, 0), x), atom_value(linear, x));
  }
  if (name == "scale") return times(call_value(nested(f, 0), x), number(f, 1, 1));
  if (name == "precompose") {
    const convex::Matrix* A = matrix(f, 1);
    if (!A) return std::nullopt;
    Real size = 0;
    return call_value(nested(f, 0),
                      affine(*A, x, vector(f, 2, static_cast<std::size_t>(A->rows()), 0), size));
  }
  if (name == "separable") {
    std::optional<CallValue> total = constant(0);
    std::size_t first = 0;
    for (std::size_t k = 0; k + 1 < f.arguments.size(); k += 2) {
      const auto size = static_cast<std::size_t>(number(f, k + 1, 1));
      const auto begin = x.begin() + static_cast<std::ptrdiff_t>(first);
      total = plus(total, call_value(nested(f, k), Point(begin, begin + static_cast<std::ptrdiff_t>(size))));
      first += size;
    }
    return total;
  }
  if (name == "perspective") {
    const Real s = x.back();
    if (!(s > 0)) return std::nullopt;
    Point inside(x.begin(), x.end() - 1);
    for (Real& v : inside) v /= s;
    return times(call_value(nested(f, 0), inside), s);
  }
  if (n == 1) {
    const auto at = [&](std::size_t k, Real w) { return call_value(nested(f, k), {w}); };
    const std::vector<Real> seeds{x[0], x[0] / 2, 1, -1, 2, 3};
    if (name == "inf_convolution")
      return one_search([&](Real w) { return plus(at(0, w), at(1, x[0] - w)); }, seeds);
    if (name == "proximal_average") {
      const Real t = number(f, 2, 0.5L), gamma = number(f, 3, 1);
      return one_search(
          [&](Real p) {
            const Real q = (x[0] - t * p) / (1 - t), square = t * (1 - t) / (2 * gamma) * (p - q) * (p - q);
            return plus(constant(square), plus(times(at(0, p), t), times(at(1, q), 1 - t)));
          },
          seeds);
    }
  }
  return atom_value(f, x);
}

}  // namespace

std::optional<CallValue> call_value(const Call& f, const Point& x, Real slack) {
  slack_of_sets = slack;
  return call_value(f, x);
}

}  // namespace fuzz
