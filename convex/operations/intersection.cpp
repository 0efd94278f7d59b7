#include <cmath>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"

namespace convex::inline operations {
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

struct EuclideanBall {
  double radius = 0;
  Vector center;
};

std::optional<EuclideanBall> euclidean_ball(const Set& set, Index n) {
  if (set.call.name != "ball2" || set.call.arguments.empty()) return std::nullopt;
  const auto* radius = std::get_if<double>(&set.call.arguments[0].value);
  if (!radius) return std::nullopt;
  if (set.call.arguments.size() == 1) return EuclideanBall{*radius, Vector::Zero(n)};
  const auto* center = std::get_if<Vector>(&set.call.arguments[1].value);
  if (!center || center->size() != n) return std::nullopt;
  return EuclideanBall{*radius, *center};
}

/// The point where two Euclidean balls touch from outside: the square of their centres' distance is that of
/// the sum of their radii, in fractions.
std::optional<Vector> point_of_touching_balls(std::span<const Set> sets, Index n) {
  for (std::size_t k = 0; k < sets.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const auto a = euclidean_ball(sets[j], n), b = euclidean_ball(sets[k], n);
      if (!a || !b || !std::isfinite(a->radius) || !std::isfinite(b->radius)) continue;
      const Fraction reach = fraction(a->radius) + fraction(b->radius);
      if (sign(reach) == 0) continue;
      Fraction beyond = -(reach * reach);
      Vector point(n);
      for (Index i = 0; i < n; ++i) {
        const Fraction from = fraction(a->center[i]), apart = fraction(b->center[i]) - from;
        beyond = beyond + apart * apart;
        point[i] = nearest_double(from + apart * (fraction(a->radius) / reach));
      }
      if (sign(beyond) == 0) return point;
    }
  return std::nullopt;
}

/// The point where a Euclidean ball touches the intersection of the other sets, polyhedra: what that has
/// nearest to the centre is, in fractions, as far from it as the radius.
std::optional<Vector> touching_point(std::span<const Set> sets, const std::vector<Function>& all, Index n) {
  constexpr double doubtful = 1e-6;  // beyond, doubles tell the distance from the radius
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const auto ball = euclidean_ball(sets[k], n);
    if (!ball) continue;
    std::vector<Function> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const Prox nearest = proper_sum(others).prox(ball->center, Metric::identity(n));
    if (nearest.x.size() != n) continue;
    const double size = ball->radius + ball->center.norm();
    if (!(std::abs((nearest.x - ball->center).norm() - ball->radius) <= doubtful * size)) continue;
    const ExactGram plain = identity_gram(static_cast<std::size_t>(n));
    std::vector<ExactProgram> rest;
    bool is_known = true;
    for (std::size_t j = 0; j < sets.size() && is_known; ++j) {
      if (j == k) continue;
      const auto program = exact_program(sets[j].call, plain);
      is_known = program.has_value();
      if (program) rest.push_back(*program);
    }
    if (!is_known) continue;
    Fractions c;
    for (const double part : ball->center) c.push_back(fraction(part));
    const ExactMinimum exact = exact_prox(exact_programs::sum(rest), plain, c);
    if (!exact.at) continue;
    const Fraction r = fraction(ball->radius);
    Fraction beyond = -(r * r);
    Vector point(n);
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Fraction off = exact.at->x[at] - c[at];
      beyond = beyond + off * off;
      point[i] = nearest_double(exact.at->x[at]);
    }
    if (sign(beyond) == 0) return point;
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
  auto point = point_of_touching_balls(sets, n);
  if (!point) point = touching_point(sets, indicators(sets), n);
  if (point) return Function(std::make_shared<Intersection>(sets, std::vector{indicator_of_point(*point)}));
  return made;
}

}  // namespace convex::inline operations
