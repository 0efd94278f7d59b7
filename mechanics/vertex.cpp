#include "mechanics/vertex.hpp"

#include <algorithm>
#include <numeric>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/active_set/working_set.hpp"
#include "convex/nearest_point/cone_projection.hpp"

namespace mechanics {
namespace {

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;

/// A rest of this part of (u_p, s_p) is rounding. A row dropped or kept by mistake shows: the reaction found
/// from the vertex is then not the one of the motion.
constexpr double rounding = 1e-12;

/// (v_a, s_a) as columns, whitened and of length 1, and (0, -1) behind them.
Matrix homogenised(const NearestPointProblem& problem) {
  const Index n = problem.dimension(), m = problem.rows();
  std::vector<Index> all(static_cast<std::size_t>(m));
  std::iota(all.begin(), all.end(), Index{0});
  Matrix E = Matrix::Zero(n + 1, m + 1);
  E.topLeftCorner(n, m) = convex::whitened_rows(problem, all);
  double unit = 0;  // of the accelerations, so that both parts of a column are alike in size
  for (Index a = 0; a < m; ++a)
    if (const double length = E.col(a).norm(); length > 0)
      unit = std::max(unit, std::abs(problem.s[a]) / length);
  if (!(unit > 0)) unit = 1;
  for (Index a = 0; a < m; ++a) {
    E(n, a) = problem.s[a] / unit;
    if (const double length = E.col(a).norm(); length > 0) E.col(a) /= length;
  }
  E(n, m) = -1;
  return E;
}

bool is_implied(const Matrix& E, Index p, const std::vector<Index>& kept,
                const std::vector<Index>& two_sided) {
  std::vector<Index> columns, free;
  for (Index a : kept) {
    if (a == p) continue;
    if (std::binary_search(two_sided.begin(), two_sided.end(), a))
      free.push_back(static_cast<Index>(columns.size()));
    columns.push_back(a);
  }
  columns.push_back(E.cols() - 1);
  const Matrix others = E(Eigen::all, columns);
  const auto found = convex::cone_projection(others, E.col(p), free);
  return found.finished && (found.point - E.col(p)).norm() <= rounding;
}

}  // namespace

std::optional<Vector> vertex_acceleration(const NearestPointProblem& problem) {
  const Matrix E = homogenised(problem);
  std::vector<Index> kept(static_cast<std::size_t>(problem.rows()));
  std::iota(kept.begin(), kept.end(), Index{0});
  for (Index p = 0; p < problem.rows(); ++p)
    if (!problem.is_two_sided(p) && is_implied(E, p, kept, problem.two_sided)) std::erase(kept, p);
  NearestPointProblem held{problem.A, problem.z, problem.U.select(kept), problem.s(kept), {}};
  held.two_sided.resize(kept.size());
  std::iota(held.two_sided.begin(), held.two_sided.end(), Index{0});
  convex::Solution solution = convex::active_set(held);
  if (solution.status != convex::Status::solved) return std::nullopt;
  return std::move(solution.q);
}

}  // namespace mechanics
