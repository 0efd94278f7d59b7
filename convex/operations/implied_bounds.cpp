#include "convex/operations/implied_bounds.hpp"

#include <algorithm>
#include <optional>

#include "convex/functions/sets.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"

namespace convex::inline operations {
namespace {

/// low <= x <= high on the domain.
struct Bounds {
  Vector low, high;
};

/// Those of a part that is steep where its domain ends, as x log x is: a sum over the entries that is neither
/// finite nor piecewise linear-quadratic.
std::optional<Bounds> steep_bounds(const Function& f, Index n) {
  const Facts facts = f.facts();
  if (!facts.separable || facts.finite || facts.piecewise_quadratic) return std::nullopt;
  Bounds found{Vector(n), Vector(n)};
  for (Index i = 0; i < n; ++i) {
    if (i > 0 && f.dimension() == 0) {
      found.low[i] = found.low[0];
      found.high[i] = found.high[0];
      continue;
    }
    const std::optional<Function> entry = f.node().entry(i);
    const auto domain = entry ? domain_of_one(*entry) : std::nullopt;
    if (!domain) return std::nullopt;
    found.low[i] = domain->low;
    found.high[i] = domain->high;
  }
  return found;
}

/// The row g x >= h of one entry holds within the bounds.
bool is_implied(double g, double h, double low, double high) { return g * (g > 0 ? low : high) >= h; }

/// What is left of a polyhedron: nothing, or one row; none where nothing is implied or more is left.
std::optional<std::vector<Function>> rest_of(const LinearQuadratic& form, const Bounds& bounds) {
  std::vector<Index> left;
  for (Index a = 0; a < form.rows(); ++a) {
    const SparseRows::InnerIterator first(form.G, a);
    const bool is_of_one = form.G.row(a).nonZeros() == 1;
    if (is_of_one &&
        is_implied(first.value(), form.h[a], bounds.low[first.col()], bounds.high[first.col()]) &&
        !std::binary_search(form.two_sided.begin(), form.two_sided.end(), a))
      continue;
    left.push_back(a);
  }
  if (left.size() > 1 || static_cast<Index>(left.size()) == form.rows()) return std::nullopt;
  if (left.empty()) return std::vector<Function>{};
  const Vector g = form.G.row(left[0]);
  const double h = form.h[left[0]];
  return std::vector<Function>{indicator(form.two_sided.empty() ? halfspace(-g, -h) : hyperplane(g, h))};
}

}  // namespace

std::vector<Function> without_implied_bounds(std::span<const Function> parts, Index n) {
  std::vector<Bounds> steep;
  for (const Function& f : parts)
    if (auto bounds = steep_bounds(f, n)) steep.push_back(*std::move(bounds));
  std::vector<Function> left;
  for (const Function& f : parts) {
    std::optional<std::vector<Function>> rest;
    if (const Facts facts = f.facts(); !steep.empty() && facts.indicator && facts.piecewise_quadratic)
      if (const auto form = f.node().linear_quadratic(n); form && form->auxiliaries() == 0)
        for (std::size_t j = 0; j < steep.size() && !rest; ++j) rest = rest_of(*form, steep[j]);
    if (rest)
      left.insert(left.end(), rest->begin(), rest->end());
    else
      left.push_back(f);
  }
  return left;
}

}  // namespace convex::inline operations
