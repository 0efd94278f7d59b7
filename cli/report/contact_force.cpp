#include "cli/report/contact_force.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

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

/// The gradient at another state, at which no entry is 0 that is another one elsewhere, as that of the x of a
/// string that hangs vertically.
Vector gradient_elsewhere(const Scene& scene, Index constraint) {
  mechanics::State moved = scene.state;
  for (Index i = 0; i < moved.q.size(); ++i) moved.q[i] += 1.0 / 16 / static_cast<double>(1 + i);
  return gradient(scene, constraint, moved);
}

/// Whether a coordinate is an Euler parameter of a body: `b_e0` beside the constraint `b_unit`.
bool is_euler_parameter(const Scene& scene, Index coordinate) {
  const std::string& name = scene.coordinates[static_cast<std::size_t>(coordinate)];
  const std::size_t end = name.rfind("_e");
  if (end == std::string::npos || end + 3 != name.size() || name.back() < '0' || name.back() > '3')
    return false;
  const std::string unit = name.substr(0, end) + "_unit";
  return std::find(scene.constraints.begin(), scene.constraints.end(), unit) != scene.constraints.end();
}

/// Whether f does not change when coordinates of two points move by the same: u_i = -u_j, wherever both are.
bool are_of_two_points(const Scene& scene, Index constraint, const Vector& u, Index i, Index j) {
  if (std::abs(u[i] + u[j]) > agreement * std::abs(u[i])) return false;
  mechanics::State moved = scene.state;
  moved.q[i] += 1.0 / 16;
  moved.q[j] += 1.0 / 16;
  return (gradient(scene, constraint, moved) - u).norm() <= agreement * u.norm();
}

/// Of the coordinates involved those that are in pairs between two points, all or none of them.
bool is_between_two_points(const Scene& scene, Index constraint, const Vector& u,
                           std::vector<Index> involved) {
  while (!involved.empty()) {
    const Index i = involved.back();
    involved.pop_back();
    const auto partner = std::find_if(involved.begin(), involved.end(),
                                      [&](Index j) { return are_of_two_points(scene, constraint, u, i, j); });
    if (partner == involved.end()) return false;
    involved.erase(partner);
  }
  return true;
}

}  // namespace

std::optional<double> force_per_multiplier(const Scene& scene, Index constraint) {
  if (!scene.system) return std::nullopt;
  const Vector u = gradient(scene, constraint, scene.state);
  const double whole = u.norm();
  const auto same = [&](const Vector& other) { return (other - u).norm() <= agreement * whole; };
  std::vector<Index> involved;
  bool is_linear = true, is_between = false;
  double length = 0;
  try {
    const Vector elsewhere = gradient_elsewhere(scene, constraint);
    for (Index i = 0; i < u.size(); ++i) {
      if ((u[i] == 0 && elsewhere[i] == 0) || is_euler_parameter(scene, i)) continue;
      if (std::abs(std::abs(u[i]) - 1) <= agreement) return std::nullopt;
      involved.push_back(i);
      length = std::hypot(length, u[i]);
      const bool changes = !same(gradient_with(scene, constraint, i, 1.0 / 16));
      if (changes && same(gradient_with(scene, constraint, i, 2 * std::numbers::pi))) return std::nullopt;
      is_linear = is_linear && !changes;
    }
    if (involved.empty() || (is_linear && involved.size() > 1)) return std::nullopt;
    is_between = is_between_two_points(scene, constraint, u, involved);
    if (is_between && involved.size() == 2) return std::nullopt;  // or of one point in a plane
  } catch (const convex::InvalidInput&) {
    return std::nullopt;  // no derivative near by
  }
  if (is_between) length /= std::numbers::sqrt2;
  if (std::abs(length - 1) <= agreement) return std::nullopt;
  return length;
}

}  // namespace cli::inline reports
