#include "cli/report/contact_force.hpp"

#include <cmath>
#include <numbers>

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;

constexpr double agreement = 1e-9;  ///< of gradients that are the same, relative

Vector gradient(const Scene& scene, Index constraint, const mechanics::State& state) {
  return convex::ConstraintRows(scene.system->contact_rows(state, {constraint}).U).row(0);
}

Vector gradient_with(const Scene& scene, Index constraint, Index coordinate, double more) {
  mechanics::State moved = scene.state;
  moved.q[coordinate] += more;
  return gradient(scene, constraint, moved);
}

}  // namespace

std::optional<double> force_per_multiplier(const Scene& scene, Index constraint) {
  if (!scene.system) return std::nullopt;
  const Vector u = gradient(scene, constraint, scene.state);
  const double length = u.norm();
  const auto same = [&](const Vector& other) { return (other - u).norm() <= agreement * length; };
  Index involved = 0;
  bool is_linear = true;
  try {
    for (Index i = 0; i < u.size(); ++i) {
      if (std::abs(std::abs(u[i]) - 1) <= agreement) return std::nullopt;
      if (u[i] == 0) continue;
      ++involved;
      const bool changes = !same(gradient_with(scene, constraint, i, 1.0 / 16));
      if (changes && same(gradient_with(scene, constraint, i, 2 * std::numbers::pi))) return std::nullopt;
      is_linear = is_linear && !changes;
    }
  } catch (const convex::InvalidInput&) {
    return std::nullopt;  // no derivative near by
  }
  if (is_linear && involved > 1) return std::nullopt;
  if (std::abs(length - 1) <= agreement) return std::nullopt;
  return length;
}

}  // namespace cli::inline reports
