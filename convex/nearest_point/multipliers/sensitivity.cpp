#include "convex/nearest_point/multipliers/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/householder.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/cone_projection.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// Multipliers that are not unique are computed: those that are this part of the largest push, each measured
/// by its row's length, or of z, count as 0.
constexpr double noise = 1e-12;

/// Whether doubles keep three digits of A⁻¹; where they do not, as of an A that is definite by fractions
/// alone, nothing is told of what it does. diag(A) over the squared pivots tells the least condition.
bool has_digits(const Metric& A) {
  constexpr double three_digits = 1e-3;
  const double condition = A.factor_condition() * A.factor_condition();
  return static_cast<double>(A.dimension()) * unit_roundoff * condition < three_digits;
}

/// By row: two-sided, or with a multiplier that is not 0 and not of a row told as weak.
std::vector<bool> loaded_rows(const NearestPointProblem& problem, const Solution& solution,
                              const Multipliers& multipliers, const std::vector<Index>& weak) {
  std::vector<bool> loaded = marked(problem.rows(), problem.two_sided);
  const Vector push =
      multipliers.least_norm.cwiseAbs().cwiseProduct(problem.U.lengths(problem.A.diagonal().cwiseInverse()));
  const double largest = std::max(solution.force_norm, push.size() > 0 ? push.maxCoeff() : 0);
  for (Index a = 0; a < push.size(); ++a)
    if (push[a] > (multipliers.unique ? 0 : noise * largest)) loaded[at(a)] = true;
  for (const Index a : weak) loaded[at(a)] = false;
  return loaded;
}

/// Of the rows of `face`, those with a positive multiplier where lambda·s is largest, lambda over all >= 0 on
/// one-sided rows with Uᵀlambda = R, and the two-sided ones. By duality these lambda are complementary to the
/// motions d with the least R·d; and such a motion is that of the quadratic problem with the linear term -t
/// R, t large enough. Whether t is: R is then a sum of pushes of the rows that d touches. None when no t will
/// do.
std::optional<std::vector<Index>> loaded_by_change(const NearestPointProblem& face, const Vector& R) {
  const double push = face.A.dual_norm(R);
  const std::vector<bool> two_sided = marked(face.rows(), face.two_sided);
  if (!(push > 0)) return face.two_sided;
  NearestPointProblem pulled = face;
  constexpr int most_trials = 8;
  constexpr double factor = 32, tight = 1e-9, balanced = 1e-9;
  const Vector lengths = face.U.lengths(face.A.diagonal().cwiseInverse());
  double way = face.A.dual_norm(face.z);  // the size of d, whatever the units of the rows are
  for (Index a = 0; a < face.rows(); ++a)
    if (lengths[a] > 0) way = std::max(way, std::abs(face.s[a]) / lengths[a]);
  double t = 2 * way / push;
  for (int trial = 0; trial < most_trials; ++trial, t *= factor) {
    pulled.z = face.z - t * R;
    const Solution moved = active_set(pulled);
    if (moved.q.size() != face.dimension()) return std::nullopt;
    std::vector<Index> rows, free;
    for (Index a = 0; a < face.rows(); ++a) {
      const bool held = two_sided[at(a)];
      const double scale = std::abs(face.s[a]) + lengths[a] * moved.acceleration_norm;
      if (!held && !(moved.slack[a] <= tight * scale)) continue;
      if (held) free.push_back(static_cast<Index>(rows.size()));
      rows.push_back(a);
    }
    const Vector whole = face.A.whiten(R);
    const ConeProjection found = cone_projection(whitened_rows(face, rows), whole, free);
    if (!((found.point - whole).norm() <= balanced * push)) continue;
    std::vector<Index> loaded;
    const auto push_of = [&](std::size_t k) {
      return found.lambda[static_cast<Index>(k)] * lengths[rows[k]];
    };
    double largest = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) largest = std::max(largest, std::abs(push_of(k)));
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (two_sided[at(rows[k])] || push_of(k) > noise * largest) loaded.push_back(rows[k]);
    return loaded;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Derivative> directional_derivative(const NearestPointProblem& problem, const Solution& solution,
                                                 const Multipliers& multipliers, const Vector& dz,
                                                 const Vector& ds, const std::vector<Index>& weak) {
  if (ds.size() != problem.rows())
    throw InvalidInput("ds: " + counted(ds.size(), "entry", "entries") + "; give " +
                       std::to_string(problem.rows()) + ", one per row of U");
  if (!has_digits(problem.A)) return std::nullopt;
  const std::vector<Index>& tight = multipliers.tight;
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided),
                          loaded = loaded_rows(problem, solution, multipliers, weak);
  const bool choose = !multipliers.unique && (ds.array() != 0).any();
  const std::vector<bool>& held = choose ? two_sided : loaded;
  NearestPointProblem face{
      problem.A, dz, problem.U.select(tight), Vector(static_cast<Index>(tight.size())), {}};
  // Rows that depend on each other within their radii do so here; the change is exact.
  face.radii = select(problem.radii, tight);
  if (face.radii) face.radii->s.setZero();
  for (std::size_t k = 0; k < tight.size(); ++k) {
    face.s[static_cast<Index>(k)] = ds[tight[k]];
    if (held[at(tight[k])]) face.two_sided.push_back(static_cast<Index>(k));
  }
  if (choose) {
    const auto rows = loaded_by_change(face, problem.U.transpose_times(multipliers.least_norm));
    if (!rows) return std::nullopt;
    face.two_sided = *rows;
  }
  const Solution moved = active_set(face, {.limit = 0});
  if (moved.q.size() != problem.dimension()) return std::nullopt;
  Derivative found{moved.q, face.U.transpose_times(moved.lambda), std::nullopt};
  // Where unique ones move into a face of many, they have no derivative.
  constexpr double tolerance = 1e-9;
  if (multipliers.unique && convex::multipliers(face, moved, tolerance, false).unique) {
    found.multipliers = Vector::Zero(problem.rows());
    for (std::size_t k = 0; k < tight.size(); ++k)
      (*found.multipliers)[tight[k]] = moved.lambda[static_cast<Index>(k)];
  }
  return found;
}

std::optional<Vector> margins(const NearestPointProblem& problem, const Solution& solution,
                              const Multipliers& multipliers, const std::vector<Index>& weak) {
  if (!multipliers.unique || !has_digits(problem.A)) return std::nullopt;
  const Index m = problem.rows();
  const std::vector<bool> loaded = loaded_rows(problem, solution, multipliers, weak),
                          two_sided = marked(m, problem.two_sided);
  std::vector<Index> held;
  for (Index a : multipliers.tight)  // independent, for the multipliers are unique
    if (loaded[at(a)]) held.push_back(a);
  const auto k = static_cast<Index>(held.size());
  Matrix Q(problem.dimension(), 0), R_inverse(0, 0);
  if (k > 0) {
    const linear_algebra::Householder factor(whitened_rows(problem, held));
    Q = factor.Q(k);
    R_inverse = Matrix::Identity(k, k);
    factor.solve_R_in_place(R_inverse);
  }
  Vector found = Vector::Constant(m, infinity);
  for (Index r = 0; r < k; ++r) {
    // dlambda = (VᵀV)⁻¹Vᵀ F⁻¹dz, whose row r has the length |R⁻¹|_r.
    const Index a = held[at(r)];
    if (!two_sided[at(a)]) found[a] = std::max(0.0, multipliers.least_norm[a]) / R_inverse.row(r).norm();
  }
  const std::vector<bool> is_tight = marked(m, multipliers.tight), is_held = marked(m, held);
  std::vector<Index> others;
  for (Index a = 0; a < m; ++a)
    if (!is_held[at(a)] && !two_sided[at(a)]) others.push_back(a);
  const Matrix V = whitened_rows(problem, others);
  const Matrix free = V - Q * (Q.transpose() * V);
  for (std::size_t j = 0; j < others.size(); ++j) {
    const Index a = others[j];
    const double reach = free.col(static_cast<Index>(j)).norm(), length = V.col(static_cast<Index>(j)).norm();
    const bool reachable = reach > 64 * unit_roundoff * static_cast<double>(problem.dimension()) * length;
    if (is_tight[at(a)])
      found[a] = 0;
    else if (reachable)
      found[a] = std::max(0.0, solution.slack[a]) / reach;
  }
  return found;
}

std::optional<FirstChange> first_change(const NearestPointProblem& problem, const Solution& solution,
                                        const Multipliers& multipliers, const Vector& dz,
                                        const Derivative& by) {
  if (!by.multipliers) return std::nullopt;
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided),
                          is_tight = marked(problem.rows(), multipliers.tight);
  const double push = problem.A.dual_norm(dz);
  std::optional<FirstChange> first;
  for (Index a = 0; a < problem.rows(); ++a) {
    if (two_sided[at(a)]) continue;
    const Vector u = problem.U.row(a);
    const double length = problem.A.dual_norm(u);
    const bool closes = !is_tight[at(a)];
    const double rate = closes ? u.dot(by.acceleration) : (*by.multipliers)[a],
                 unit = closes ? length : 1 / length,
                 left = closes ? solution.slack[a] : multipliers.least_norm[a];
    if (!(-rate > noise * unit * push)) continue;  // what is no more than rounding changes nothing
    const double reach = std::max(0.0, left) / -rate;
    if (!first || reach < first->by) first = FirstChange{reach, a, closes};
  }
  return first;
}

}  // namespace convex::inline multiplier_sets
