#include "cli/drawing/plane_section.hpp"

#include <algorithm>
#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

Index coordinate_named(const Scene& scene, std::string name) {
  name.erase(0, std::min(name.size(), name.find_first_not_of(' ')));
  name.erase(name.find_last_not_of(' ') + 1);
  const auto found = std::find(scene.coordinates.begin(), scene.coordinates.end(), name);
  if (found == scene.coordinates.end())
    throw InvalidInput("--plane: no coordinate \"" + name + "\"; " +
                       convex::suggestion(name, scene.coordinates));
  return static_cast<Index>(found - scene.coordinates.begin());
}

/// The comma that stands outside brackets.
std::size_t comma_of(const std::string& plane) {
  int depth = 0;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    depth += plane[i] == '[' ? 1 : plane[i] == ']' ? -1 : 0;
    if (plane[i] == ',' && depth == 0) return i;
  }
  return std::string::npos;
}

std::array<Index, 2> axes_of(const SolvedScene& solved, const std::optional<std::string>& plane) {
  const Scene& scene = solved.scene;
  const Index n = scene.problem.dimension();
  if (n < 2)
    throw InvalidInput("--plot: " + scene.file +
                       " has one coordinate; a picture of the decomposition needs two; of a mechanism [draw] "
                       "says what there is to draw");
  if (plane) {
    const std::size_t comma = comma_of(*plane);
    if (comma == std::string::npos)
      throw InvalidInput("--plane " + *plane + ": not two coordinates; write --plane x,y");
    const Index i = coordinate_named(scene, plane->substr(0, comma)),
                j = coordinate_named(scene, plane->substr(comma + 1));
    if (i == j) throw InvalidInput("--plane " + *plane + ": twice the same coordinate; name two");
    return {i, j};
  }
  if (n == 2) return {0, 1};
  // By the part of the kinetic metric that the reactions change in each.
  Vector changed = (solved.solution.primal.q - scene.problem.A.solve(scene.problem.z)).cwiseAbs();
  changed = changed.cwiseProduct(scene.problem.A.diagonal().cwiseSqrt());
  Index first = 0, second = 0;
  changed.maxCoeff(&first);
  changed[first] = -1;
  changed.maxCoeff(&second);
  return {std::min(first, second), std::max(first, second)};
}

}  // namespace

PlaneSection plane_section(const SolvedScene& solved, const std::optional<std::string>& plane) {
  const Scene& scene = solved.scene;
  if (!solved.has_answer())
    throw InvalidInput("--plot: " + scene.file + " has no solution to draw; leave --plot out");
  const convex::NearestPointProblem& problem = scene.problem;
  const Vector& q = solved.solution.primal.q;
  PlaneSection section;
  section.axes = axes_of(solved, plane);
  const auto [i, j] = section.axes;
  const Vector first = problem.A.multiply(Vector::Unit(problem.dimension(), i)),
               second = problem.A.multiply(Vector::Unit(problem.dimension(), j));
  section.A << first[i], second[i], first[j], second[j];
  section.truth = {q[i], q[j]};
  // A_pp p = z_p - A_pr q_r, the rest held.
  const Vector gradient = problem.A.multiply(q) - problem.z;
  const double determinant = first[i] * second[j] - first[j] * second[i];
  section.free = section.truth - Eigen::Vector2d(second[j] * gradient[i] - second[i] * gradient[j],
                                                 first[i] * gradient[j] - first[j] * gradient[i]) /
                                     determinant;
  const mechanics::TwoSided& classical = solved.solution.hypothesis.two_sided;
  if (problem.dimension() == 2 && classical.consistent && classical.acceleration.size() == 2)
    section.classical = Eigen::Vector2d(classical.acceleration);
  const auto& tight = solved.solution.multipliers.tight;
  for (Index a = 0; a < problem.rows(); ++a) {
    const Vector u = problem.U.row(a);
    PlaneSection::Row row{
        {u[i], u[j]},
        0,
        a,
        std::find(tight.begin(), tight.end(), a) != tight.end(),
        std::find(problem.two_sided.begin(), problem.two_sided.end(), a) != problem.two_sided.end()};
    if (row.u.isZero(0)) {
      section.without_line.push_back(a);
      continue;
    }
    row.s = problem.s[a] - (u.dot(q) - row.u.dot(section.truth));
    section.rows.push_back(row);
  }
  return section;
}

}  // namespace cli::inline drawings
