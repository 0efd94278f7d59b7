#include "tests/fuzz/call_value.hpp"

#include <numeric>
#include <string>

#include "tests/fuzz/call_arguments.hpp"

namespace fuzz {
namespace {

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
/// Whether (x|y) = x·y, which alone is known here of operations that take the product of the metric.
thread_local bool plain_product = true;

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
  constexpr Real rounding_of_terms = 0x1p-60L;
  bool known = true;
  const auto at = [&](Real w) {
    const std::optional<CallValue> value = both(w);
    known = known && value;
    // Far out, large terms may leave less than the least value by their rounding.
    return value ? value->value + rounding_of_terms * value->size : infinity;
  };
  const LineMinimum least = least_on_line(at, seeds);
  const auto value = both(least.at);
  if (!known || !value) return std::nullopt;
  return CallValue{value->value, false, value->size};
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

}  // namespace

std::optional<CallValue> value_of_call(const Call& f, const Point& x) {
  const std::size_t n = x.size();
  const std::string& name = f.name;
  if (name == "indicator") return set_value(nested(f, 0), x);
  if (name == "sum") {
    std::optional<CallValue> total = constant(0);
    for (std::size_t k = 0; k < f.arguments.size(); ++k) total = plus(total, value_of_call(nested(f, k), x));
    return total;
  }
  if (name == "pointwise_max") {
    std::optional<CallValue> most;
    for (std::size_t k = 0; k < f.arguments.size(); ++k) {
      const auto part = value_of_call(nested(f, k), x);
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
    auto part = value_of_call(nested(f, 0), moved);
    return part;
  }
  if (name == "tilt") {
    const Call linear{"linear", {f.arguments[1]}, {}};
    return plus(value_of_call(nested(f, 0), x), atom_value(linear, x));
  }
  if (name == "scale") return times(value_of_call(nested(f, 0), x), number(f, 1, 1));
  if (name == "precompose") {
    const convex::Matrix* A = matrix(f, 1);
    if (!A) return std::nullopt;
    Real size = 0;
    return value_of_call(nested(f, 0),
                         affine(*A, x, vector(f, 2, static_cast<std::size_t>(A->rows()), 0), size));
  }
  if (name == "separable") {
    std::optional<CallValue> total = constant(0);
    std::size_t first = 0;
    for (std::size_t k = 0; k + 1 < f.arguments.size(); k += 2) {
      const auto size = static_cast<std::size_t>(number(f, k + 1, 1));
      const auto begin = x.begin() + static_cast<std::ptrdiff_t>(first);
      total =
          plus(total, value_of_call(nested(f, k), Point(begin, begin + static_cast<std::ptrdiff_t>(size))));
      first += size;
    }
    return total;
  }
  if (name == "perspective") {
    const Real s = x.back();
    if (!(s > 0)) return std::nullopt;
    Point inside(x.begin(), x.end() - 1);
    for (Real& v : inside) v /= s;
    return times(value_of_call(nested(f, 0), inside), s);
  }
  if (n == 1) {
    const auto at = [&](std::size_t k, Real w) { return value_of_call(nested(f, k), {w}); };
    const std::vector<Real> seeds{x[0], x[0] / 2, 1, -1, 2, 3};
    if (name == "inf_convolution")
      return one_search([&](Real w) { return plus(at(0, w), at(1, x[0] - w)); }, seeds);
    if (name == "proximal_average") {
      if (!plain_product) return std::nullopt;
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

void set_product(bool is_plain) { plain_product = is_plain; }

std::optional<CallValue> call_value(const Call& f, const Point& x, Real slack) {
  slack_of_sets = slack;
  return value_of_call(f, x);
}

}  // namespace fuzz
