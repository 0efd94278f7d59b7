#include "convex/nearest_point/proof/uncertain_problem.hpp"

#include <algorithm>
#include <cmath>

#include "convex/exact/positive_definite.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace convex::inline proof {
namespace {

/// The nearest doubles of the middle, with what their rounding adds.
Vector size_above(const Vector& x) { return above(1) * x.cwiseAbs(); }

bool is_usable(const Matrix& radii) {
  constexpr double largest = 0x1p300, smallest = 0x1p-900;
  return (radii.array() <= largest).all() && (radii.array() == 0 || radii.array() >= smallest).all();
}

/// What bounds in the metric of any problem within the radii need: with D = diag A of the middle, A >= floor
/// D for the middle, and (1 - change) A_middle <= A <= (1 + change) A_middle.
struct MetricBounds {
  Vector D;
  double floor = 0, change = 0;
};

/// Whether A - 2^-shift diag A is positive definite.
bool exceeds_its_diagonal(const ExactProblem& middle, int shift) {
  IntegerRows A = middle.A;
  const Integer scale = Integer::shifted(1, static_cast<unsigned long>(shift));
  for (std::size_t i = 0; i < A.size(); ++i)
    for (std::size_t j = 0; j < A.size(); ++j) A[i][j] = i == j ? A[i][j] * (scale - 1) : A[i][j] * scale;
  return is_positive_definite(A);
}

std::optional<MetricBounds> metric_bounds(const UncertainProblem& problem, const NearestPointProblem& near) {
  MetricBounds found;
  const Matrix A = near.A.dense_gram();
  found.D = A.diagonal();
  const Vector scale = found.D.cwiseSqrt().cwiseInverse();
  const Matrix unit = scale.asDiagonal() * A * scale.asDiagonal();
  const double least = linear_algebra::eigenvalues(unit)[0];
  constexpr int most = 120, stride = 30;
  int shift = least > 0x1p-40 ? 1 - std::ilogb(least) : most / 2;
  for (; shift <= most && !exceeds_its_diagonal(problem.middle, shift);) shift += stride;
  if (shift > most) return std::nullopt;
  found.floor = std::ldexp(1.0, -shift);
  const Matrix change = scale.asDiagonal() * problem.A * scale.asDiagonal();
  found.change = above(change.rowwise().sum().maxCoeff()) / found.floor;
  found.change = above(found.change);
  if (!(found.change < 0.5)) return std::nullopt;
  return found;
}

/// A motion Y r, |r| <= 1 entry by entry, that meets two-sided rows missed by at most r: `reach` bounds
/// |Y| summed over rows, after the uncertainty of the rows themselves; empty when nothing is to be met.
std::optional<Vector> reach_of_two_sided(const UncertainProblem& problem, const NearestPointProblem& near) {
  const std::vector<Index>& rows = problem.middle.two_sided;
  const Index n = problem.middle.dimension(), k = static_cast<Index>(rows.size());
  bool certain = true;
  for (Index a : rows) certain = certain && problem.s[a] == 0 && (problem.U.row(a).array() == 0).all();
  if (certain) return Vector();
  if (k > n) return std::nullopt;
  RowMatrix E(k, n), radius(k, n);
  for (Index r = 0; r < k; ++r) {
    E.row(r) = near.U.row(rows[at(r)]).transpose();
    radius.row(r) = problem.U.row(rows[at(r)]);
  }
  const Matrix Y = linear_algebra::CompleteOrthogonal(E).pseudo_inverse();
  if (!Y.allFinite()) return std::nullopt;
  const Matrix miss =
      (E * Y - Matrix::Identity(k, k)).cwiseAbs() +
      (gamma(n) * E.cwiseAbs() + above(1) * radius + 2 * unit_roundoff * E.cwiseAbs()) * Y.cwiseAbs() +
      2 * unit_roundoff * Matrix::Identity(k, k);
  const double error = above(miss.rowwise().sum().maxCoeff());
  if (!(error < 0.5)) return std::nullopt;
  return Vector(above(1 / (1 - error)) * Y.cwiseAbs().rowwise().sum());
}

/// Bounds at a point x, |x| <= size, over all problems within the radii.
struct Reach {
  Vector move;  ///< |c| of the motion x -> x + c that meets the two-sided rows: n
  Vector rows;  ///< |u_a·(x + c) - s_a - (middle u_a·x - s_a)|: m
};

Reach reach_at(const UncertainProblem& problem, const NearestPointProblem& near, const Vector& two_sided,
               const Vector& size) {
  Reach found;
  found.rows = above(1) * (problem.s + problem.U * size);
  found.move = Vector::Zero(size.size());
  if (two_sided.size() == 0) return found;
  double miss = 0;
  for (Index a : problem.middle.two_sided) miss = std::max(miss, found.rows[a]);
  found.move = above(miss) * two_sided;
  found.rows += above(1) * ((near.U.dense().cwiseAbs() * above(1) + problem.U) * found.move);
  return found;
}

ExactProblem with_bounds_moved(ExactProblem problem, const Vector& by) {
  for (std::size_t a = 0; a < problem.s.size(); ++a) {
    const double move = by[static_cast<Index>(a)];
    if (move == 0) continue;
    const Fraction raised = lowest_terms({problem.s[a], problem.row_unit[a]}) + fraction(move);
    const Integer common = greatest_common_divisor(problem.row_unit[a], raised.denominator);
    const Integer factor = exact_quotient(raised.denominator, common);
    for (Integer& entry : problem.U[a]) entry *= factor;
    problem.s[a] = raised.numerator * exact_quotient(problem.row_unit[a], common);
    problem.row_unit[a] *= factor;
  }
  return problem;
}

/// Σ w_a u_a = 0 and Σ w_a s_a > 0 for every problem within the radii.
bool is_certain_contradiction(const UncertainProblem& problem, const IntegerVector& w) {
  Fraction left{};
  for (std::size_t a = 0; a < w.size(); ++a) {
    if (w[a].is_zero()) continue;
    const auto row = static_cast<Index>(a);
    if (!(problem.U.row(row).array() == 0).all()) return false;
    const Fraction weight{w[a], 1}, size{w[a].sign() < 0 ? -w[a] : w[a], 1};
    left = left + weight * Fraction{problem.middle.s[a], problem.middle.row_unit[a]} -
           size * fraction(problem.s[row]);
  }
  return sign(left) > 0;
}

class Enclosing {
 public:
  Enclosing(const UncertainProblem& problem, const std::vector<Index>& guess)
      : problem_(problem), near_(rounded(problem.middle)), guess_(guess) {}

  std::optional<EnclosedSolution> solve() {
    const auto metric = metric_bounds(problem_, near_);
    const auto two_sided = reach_of_two_sided(problem_, near_);
    if (!metric) return std::nullopt;
    if (!two_sided) return contradiction(Vector::Zero(problem_.middle.rows()));
    // The point is not known yet: its size is taken from the middle problem, and found out to be enough
    // below.
    const ExactSolution middle = exact_active_set(problem_.middle, guess_);
    const Vector size = middle.status == Status::infeasible ? Vector(Vector::Ones(problem_.z.size()))
                                                            : Vector(nearest(middle.q).cwiseAbs());
    const double spread = std::max(size.maxCoeff(), 0x1p-300) * 0x1p-20;
    const Reach guessed =
        reach_at(problem_, near_, *two_sided, 2 * size + Vector::Constant(size.size(), spread));
    Vector raise = 2 * guessed.rows;
    for (Index a : problem_.middle.two_sided) raise[a] = 0;
    if (!raise.allFinite()) return std::nullopt;
    const ExactSolution solution = exact_active_set(with_bounds_moved(problem_.middle, raise), guess_);
    if (solution.status == Status::infeasible) return contradiction(-raise);
    return enclosed(*metric, *two_sided, raise, solution);
  }

 private:
  /// The middle problem with its uncertain bounds lowered: what contradicts itself still does so everywhere.
  std::optional<EnclosedSolution> contradiction(const Vector& lowering) const {
    const ExactSolution lowered = exact_active_set(with_bounds_moved(problem_.middle, lowering), guess_);
    if (lowered.status != Status::infeasible || !is_certain_contradiction(problem_, lowered.farkas))
      return std::nullopt;
    EnclosedSolution found;
    found.status = Status::infeasible;
    found.farkas = lowered.farkas;
    return found;
  }

  std::optional<EnclosedSolution> enclosed(const MetricBounds& metric, const Vector& two_sided,
                                           const Vector& raise, const ExactSolution& solution) const {
    const Vector size = size_above(nearest(solution.q)), lambda = size_above(nearest(solution.lambda));
    const Reach reach = reach_at(problem_, near_, two_sided, size);
    double gap = 0;  // 2 Σ lambda_a (u_a·(x + c) - s_a)
    const std::vector<bool> is_two_sided = marked(problem_.middle.rows(), problem_.middle.two_sided);
    for (Index a = 0; a < problem_.middle.rows(); ++a) {
      if (is_two_sided[at(a)]) continue;
      const double slack = nearest_double(solution.slack[at(a)]);  // over the raised bound
      if (!(below(slack + raise[a]) >= above(reach.rows[a]))) return std::nullopt;
      gap += 2 * lambda[a] * (slack + raise[a] + reach.rows[a]);
    }
    // ||z + Uᵀlambda - A x||_(A⁻¹) with the middle's being 0, and ||c||_A.
    const Vector balance = problem_.z + problem_.U.transpose() * lambda + problem_.A * size;
    const double imbalance = above(norm_above(balance.cwiseQuotient(metric.D.cwiseSqrt())) /
                                   std::sqrt(below((1 - metric.change) * metric.floor)));
    EnclosedSolution found;
    found.q = solution.q;
    found.stretch = above(std::sqrt(1 + metric.change));
    const double move = above(found.stretch * above(reach.move.dot(metric.D.cwiseSqrt())));
    found.radius = above(move + std::hypot(above(imbalance + move), std::sqrt(above(gap))));
    if (!std::isfinite(found.radius)) return std::nullopt;
    return found;
  }

  const UncertainProblem& problem_;
  const NearestPointProblem near_;
  const std::vector<Index>& guess_;
};

}  // namespace

std::optional<EnclosedSolution> enclosed_solution(const UncertainProblem& problem,
                                                  const std::vector<Index>& guess) {
  if (!is_usable(problem.A) || !is_usable(problem.z) || !is_usable(problem.U) || !is_usable(problem.s))
    return std::nullopt;
  try {
    return Enclosing(problem, guess).solve();
  } catch (const InvalidInput&) {
    return std::nullopt;  // doubles are too coarse for the middle
  }
}

Decimals decimals(const UncertainProblem& problem, const EnclosedSolution& solution, int digits) {
  Decimals found;
  std::vector<Fraction> read;
  for (std::size_t i = 0; i < solution.q.numerators.size(); ++i) {
    found.entries.push_back(decimal_text(entry(solution.q, i), digits));
    read.push_back(*read_fraction(found.entries.back()));
  }
  const ExactVector q = exact_vector(read);
  const double cut = root_above(squared_distance(problem.middle, q, solution.q));
  found.radius = above(solution.radius + solution.stretch * cut);
  return found;
}

double distance_above(const UncertainProblem& problem, const EnclosedSolution& solution, const Vector& x) {
  return above(solution.stretch * distance_above(problem.middle, x, solution.q) + solution.radius);
}

}  // namespace convex::inline proof
