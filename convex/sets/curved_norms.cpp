#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/subdifferential_rules.hpp"

namespace convex::inline sets::subgradients {
namespace {

/// The root of a positive fraction, rounded, also of one that no double is near.
Fraction norm_rounded(Fraction square) {
  constexpr double step = 0x1p+400, least = 0x1p-900;
  const Fraction factor = fraction(step), inverse = Fraction{1} / factor;
  Fraction scale{1};
  for (; std::isinf(nearest_double(square)); scale = scale * factor) square = square * inverse * inverse;
  for (; nearest_double(square) < least; scale = scale * inverse) square = square * factor * factor;
  return fraction(std::sqrt(nearest_double(square))) * scale;
}

Subdifferential of_norm2(const Fraction& weight, const Fractions& x) {
  const Fraction square = pairs::square_of(x);
  if (sign(weight) == 0) return single(Fractions(x.size()), true);
  if (sign(square) == 0)
    return of_support({"norm2", {argument("weight", nearest_double(weight))}}, x.size(), true);
  return single(pairs::multiple_of(weight / norm_rounded(square), x), false);
}

Subdifferential of_ball2(const Fraction& radius, const Fractions& d) {
  const Fraction left = radius * radius - pairs::square_of(d);
  if (sign(left) < 0) return none(d.size());
  if (sign(left) > 0) return single(Fractions(d.size()), true);
  if (sign(radius) == 0) {  // a point
    ExactPolyhedron all = empty_polyhedron(d.size());
    all.vertices.emplace_back(d.size());
    for (std::size_t i = 0; i < d.size(); ++i) {
      all.lines.emplace_back(d.size());
      all.lines.back()[i] = 1;
    }
    return of_polyhedron(std::move(all), true);
  }
  return ray(d, true);
}

/// The entries of each group, by their sizes.
std::vector<Fractions> groups_of(const ExactArguments& a, const Fractions& x) {
  std::vector<std::size_t> sizes;
  if (a.is_vector("sizes"))
    for (const Fraction& size : a.vector("sizes"))
      sizes.push_back(static_cast<std::size_t>(nearest_double(size)));
  else
    sizes.assign(x.size(), static_cast<std::size_t>(nearest_double(a.number("sizes"))));
  std::vector<Fractions> groups;
  std::size_t first = 0;
  for (const std::size_t size : sizes) {
    if (first >= x.size()) break;
    const std::size_t last = std::min(first + size, x.size());
    groups.emplace_back(x.begin() + static_cast<std::ptrdiff_t>(first),
                        x.begin() + static_cast<std::ptrdiff_t>(last));
    first = last;
  }
  return groups;
}

template <class Rule>
Subdifferential of_groups(const ExactArguments& a, const Fractions& x, const Rule& rule) {
  std::vector<Subdifferential> parts;
  for (const Fractions& group : groups_of(a, x)) parts.push_back(rule(group));
  return product(parts);
}

/// {x : g(x) <= 0} at a point of a smooth edge, where g(x) = 0 and its gradient is not 0.
Subdifferential of_second_order_cone(const Fractions& x) {
  Fractions normal = x;
  normal.back() = -x.back();
  const Fraction left = x.back() * x.back() - pairs::square_of({x.begin(), x.end() - 1});
  if (sign(x.back()) < 0 || sign(left) < 0) return none(x.size());
  if (sign(left) > 0) return single(Fractions(x.size()), true);
  if (sign(x.back()) > 0) return ray(normal, true);
  return of_support(indicator_call({"second_order_cone"}), x.size(), false);
}

Subdifferential of_rotated_cone(const Fractions& x) {
  const std::size_t n = x.size();
  const Fraction u = x[n - 2], v = x[n - 1];
  const Fraction left = Fraction{2} * u * v - pairs::square_of({x.begin(), x.end() - 2});
  if (sign(u) < 0 || sign(v) < 0 || sign(left) < 0) return none(n);
  if (sign(left) > 0) return single(Fractions(n), true);
  if (sign(u) == 0 && sign(v) == 0)
    return of_support(indicator_call({"rotated_second_order_cone"}), n, false);
  Fractions normal = x;
  normal[n - 2] = -v;
  normal[n - 1] = -u;
  return ray(normal, true);
}

/// weight times the gauge of unit vectors with k entries: v = x/ρ on the largest entries, of one size A/ρ
/// with the sign of x on the others that are not 0, and in [-A, A]/ρ where x is, A = Σ of the others / (r +
/// 1), ρ² = Σ of the largest squares + (r + 1) A² (Argyriou, Foygel and Srebro 2012). Which are the largest
/// is decided in fractions.
std::optional<Subdifferential> of_k_support(const ExactArguments& a, const Fractions& x) {
  const std::size_t n = x.size();
  const auto k = static_cast<std::size_t>(nearest_double(a.number("k")));
  const Fraction weight = a.number("weight");
  if (sign(pairs::square_of(x)) == 0) return std::nullopt;
  if (sign(weight) == 0) return single(Fractions(n), true);
  const auto size = [&](std::size_t i) { return sign(x[i]) < 0 ? -x[i] : x[i]; };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return size(j) < size(i); });
  // x_(k-r-1) > A >= x_(k-r), counted from 1, x_(0) infinite.
  Fraction rest, level;
  for (std::size_t i = k - 1; i < n; ++i) rest = rest + size(order[i]);
  std::size_t many = k - 1;  // entries above the level
  for (std::size_t r = 0;; ++r, --many) {
    level = rest / Fraction{static_cast<std::int64_t>(r + 1)};
    const bool above_next = !(level < size(order[many]));
    if (above_next && (many == 0 || level < size(order[many - 1]))) break;
    if (many == 0) return std::nullopt;
    rest = rest + size(order[many - 1]);
  }
  Fraction square = level * level * Fraction{static_cast<std::int64_t>(k - many)};
  for (std::size_t i = 0; i < many; ++i) square = square + x[order[i]] * x[order[i]];
  const Fraction factor = weight / norm_rounded(square);
  std::vector<Subdifferential> entries(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = order[i];
    if (i < many)
      entries[at] = single({factor * x[at]}, false);
    else if (sign(x[at]) != 0)
      entries[at] = single({sign(x[at]) < 0 ? -(factor * level) : factor * level}, false);
    else if (sign(level) == 0)
      entries[at] = single({Fraction{}}, false);
    else
      entries[at] = hull({single({factor * level}, false), single({-(factor * level)}, false)});
  }
  return product(entries);
}

}  // namespace

std::optional<Subdifferential> of_curved_norm_or_set(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  if (f.name == "norm2") return of_norm2(a.number("weight"), x);
  if (f.name == "ball2") return of_ball2(a.number("radius"), difference(x, a.vector("center")));
  if (f.name == "group_norm")
    return of_groups(a, x, [&](const Fractions& group) { return of_norm2(a.number("weight"), group); });
  if (f.name == "group_ball")
    return of_groups(a, x, [&](const Fractions& group) { return of_ball2(a.number("radius"), group); });
  if (f.name == "second_order_cone") return of_second_order_cone(x);
  if (f.name == "rotated_second_order_cone") return of_rotated_cone(x);
  if (f.name == "k_support") return of_k_support(a, x);
  return std::nullopt;
}

}  // namespace convex::inline sets::subgradients
