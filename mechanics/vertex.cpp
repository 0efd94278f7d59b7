#include "mechanics/vertex.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/cone_projection.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace mechanics {
namespace {

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::unit_roundoff;

/// So many times farther than the problem's own size lies the point whose projection is the vertex: from
/// there it is, unless the cone is flatter than that.
constexpr double depth = 0x1p20;

/// A rest of so many roundings of u_p is what finding it leaves; a slack of so many, of its terms, is 0.
constexpr double rest_roundings = 64 * unit_roundoff;

/// The point of C that is lowest for the sum of the one-sided u_a, each of length 1, where that has one.
convex::Solution lowest_point(const NearestPointProblem& problem, const Vector& length, double limit) {
  NearestPointProblem deep = problem;
  Vector sum = Vector::Zero(problem.dimension());
  double size = problem.A.dual_norm(problem.z);
  for (Index a = 0; a < problem.rows(); ++a) {
    if (!(length[a] > 0)) continue;
    size = std::max(size, std::abs(problem.s[a]) / length[a]);
    if (!problem.is_two_sided(a)) sum += problem.U.row(a) / length[a];
  }
  deep.z -= depth * (size > 0 ? size : 1) * sum;
  return convex::active_set(deep, {.limit = limit});
}

}  // namespace

std::optional<Vector> vertex_acceleration(const NearestPointProblem& problem, double limit) {
  const Index m = problem.rows();
  std::vector<Index> all(static_cast<std::size_t>(m)), held, free, others;
  std::iota(all.begin(), all.end(), Index{0});
  Matrix V = convex::whitened_rows(problem, all);
  const Vector length = V.colwise().norm();
  convex::Solution lowest = lowest_point(problem, length, limit);
  if (lowest.status != convex::Status::solved) return std::nullopt;
  const convex::DoubleDoubleVector q(lowest.q);
  const Vector size = lowest.q.cwiseAbs();
  for (Index a = 0; a < m; ++a) {
    if (!(length[a] > 0)) continue;
    V.col(a) /= length[a];
    const double open = length[a] * lowest.error_bound +
                        rest_roundings * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, size));
    const bool holds = problem.is_two_sided(a) || convex::slack(problem, a, q).value() <= open;
    if (problem.is_two_sided(a)) free.push_back(static_cast<Index>(held.size()));
    (holds ? held : others).push_back(a);
  }
  const Matrix generators = V(Eigen::all, held);
  for (Index p : others) {
    const auto found = convex::cone_projection(generators, V.col(p), free);
    if (!found.finished || !((found.point - V.col(p)).norm() <= rest_roundings)) return std::nullopt;
  }
  return std::move(lowest.q);
}

}  // namespace mechanics
