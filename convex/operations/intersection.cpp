#include "convex/double_double.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"

namespace convex {
namespace {

std::vector<Function> indicators(std::span<const Set> sets) {
  std::vector<Function> all;
  for (const Set& set : sets) all.push_back(set.indicator);
  return all;
}

/// The sum of the indicators, under the name of the set.
class Intersection : public Sum {
 public:
  explicit Intersection(std::span<const Set> sets) : Intersection(sets, indicators(sets)) {}
  Intersection(std::span<const Set> sets, std::vector<Function> parts) : Sum(std::move(parts)) {
    call_.name = "intersection";
    for (const Set& set : sets) call_.arguments.push_back(argument(set.call));
  }
  Call call() const override { return {"indicator", {argument(call_)}}; }

 private:
  Call call_;
};

/// The point where a Euclidean ball touches the intersection of the others, without rounding: what that is
/// nearest to the centre is as far from it as the radius.
std::optional<Vector> point_of_contact(std::span<const Set> sets, const std::vector<Function>& all) {
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const Call& call = sets[k].call;
    if (call.name != "ball2" || call.arguments.size() < 2) continue;
    const auto* radius = std::get_if<double>(&call.arguments[0].value);
    const auto* center = std::get_if<Vector>(&call.arguments[1].value);
    if (!radius || !center) continue;
    std::vector<Function> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const Prox nearest = proper_sum(others).prox(*center, Metric::identity(center->size()));
    if (nearest.status != Status::solved) continue;
    ExactSum rest;
    rest.add_product(-*radius, *radius);
    bool is_exact = true;
    for (Index i = 0; i < center->size(); ++i) {
      const DoubleDouble off = two_sum(nearest.x[i], -(*center)[i]);
      is_exact = is_exact && off.lo == 0;
      rest.add_product(off.hi, off.hi);
    }
    if (is_exact && rest.sign() == 0) return nearest.x;
  }
  return std::nullopt;
}

}  // namespace

Function intersection(std::span<const Set> sets, Index n) {
  if (sets.empty()) throw InvalidInput("intersection: no sets; give at least one");
  if (sets.size() == 1) return sets[0].indicator;
  const Function made(std::make_shared<Intersection>(sets));
  if (made.dimension() != 0) n = made.dimension();
  if (n == 0) return made;
  require_proper(made, n, "intersection");
  if (made.facts().piecewise_quadratic) return made;
  if (const auto point = point_of_contact(sets, indicators(sets)))
    return Function(std::make_shared<Intersection>(sets, std::vector{indicator_of_point(*point)}));
  return made;
}

}  // namespace convex
