#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/methods/every_method.hpp"

#include "convex/linear_algebra/cholesky.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/reductions/whitened_problem.hpp"

namespace convex::inline algorithms {
namespace {

/// Added to M, whose diagonal is 1.
constexpr double ridge = 1e-9;
constexpr int most_proximal_steps = 12;

/// Blocks that need not lower the number of wrong signs, and systems in all.
constexpr int patience = 3;
constexpr Index most_steps = 20000;

/// Signs are wrong beyond this part of the largest multiplier or bound.
constexpr double noise = 1e-13;

class Pivoting {
 public:
  explicit Pivoting(const Matrix& M) : M_(M), in_(at(M.rows()), false) {}

  /// Solves w = M y - c, y, w >= 0, y·w = 0 from the rows that the last call ended with; false when neither
  /// blocks nor `singles` changes of one row lead there, or at the limit.
  bool solve(const Vector& c, Index singles, Index limit, Vector& y) {
    Index fewest = M_.rows() + 1;
    for (int left = patience; steps_ < limit; ++steps_) {
      point(c, y);
      const std::vector<Index> wrong = wrong_rows(c, y);
      const Index count = static_cast<Index>(wrong.size());
      if (count == 0) return true;
      if (count < fewest) {
        fewest = count;
        left = patience;
      } else if (left > 0) {
        --left;
      } else if (singles-- > 0) {
        turn(worst(wrong, y));
        continue;
      } else {
        return false;
      }
      for (Index a : wrong) turn(a);
    }
    return false;
  }
  bool holds(Index a) const { return in_[at(a)]; }
  Index steps() const { return steps_; }

 private:
  void point(const Vector& c, Vector& y) {
    std::vector<Index> rows;
    for (Index a = 0; a < c.size(); ++a)
      if (in_[at(a)]) rows.push_back(a);
    y.setZero(c.size());
    w_ = -c;
    if (rows.empty()) return;
    const Matrix columns = M_(Eigen::all, rows), block = columns(rows, Eigen::all);
    const linear_algebra::Cholesky factor(block);
    const Vector right = c(rows);
    Vector part = factor.solve(right);
    part += factor.solve(right - block * part);
    y(rows) = part;
    w_.noalias() += columns * part;
  }

  /// The most negative among rows of a wrong sign.
  Index worst(const std::vector<Index>& wrong, const Vector& y) const {
    const auto value = [&](Index a) { return in_[at(a)] ? y[a] : w_[a]; };
    return *std::min_element(wrong.begin(), wrong.end(),
                             [&](Index a, Index b) { return value(a) < value(b); });
  }

  void turn(Index a) { in_[at(a)] = !in_[at(a)]; }

  std::vector<Index> wrong_rows(const Vector& c, const Vector& y) const {
    std::vector<Index> rows;
    if (c.size() == 0) return rows;
    const double least = noise * (c.cwiseAbs().maxCoeff() + y.cwiseAbs().maxCoeff());
    for (Index a = 0; a < c.size(); ++a)
      if (in_[at(a)] ? y[a] < 0 : w_[a] < -least) rows.push_back(a);
    return rows;
  }

  const Matrix& M_;
  std::vector<bool> in_;
  Vector w_;
  Index steps_ = 0;
};

}  // namespace

Solution block_pivoting(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "block-pivoting", accuracy)) return *found;
  const WhitenedProblem white(problem);
  const Complementarity lcp(white);
  const Index k = lcp.b.size();
  const Index limit = accuracy.step_limit > 0 ? accuracy.step_limit : most_steps;
  const Index singles = 2 * std::min(k, problem.dimension());
  const Matrix definite = lcp.M + ridge * Matrix::Identity(k, k);
  Pivoting pivoting(definite);
  Candidate candidate{.method = "block-pivoting", .q = {}, .lambda = {}, .farkas = {}};
  Vector center = Vector::Zero(k), y;
  for (int step = 0; step < most_proximal_steps; ++step) {
    candidate.finished = pivoting.solve(lcp.b + ridge * center, singles, limit, y);
    candidate.steps = pivoting.steps();
    if (!candidate.finished) break;
    candidate.lambda = white.multipliers(lcp.with_free(white, y));
    candidate.farkas = white.weights(lcp.with_free(white, y - center));
    Solution found = crossover(problem, candidate, accuracy);
    if (found.status == Status::solved || found.status == Status::infeasible) return found;
    center = y;
  }
  if (pivoting.steps() < limit) {
    std::vector<Index> rows;
    for (Index a = 0; a < k; ++a)
      if (pivoting.holds(a)) rows.push_back(white.rows[at(lcp.columns[static_cast<std::size_t>(a)])]);
    Accuracy rest = accuracy;
    rest.limit = 0;  // `crossover` decides what is left open
    if (rest.step_limit > 0) rest.step_limit -= pivoting.steps();
    const Solution one_by_one = active_set(problem, rest, rows);
    candidate.finished = one_by_one.status != Status::gave_up;
    candidate.q = one_by_one.q;
    candidate.lambda = one_by_one.lambda;
    candidate.farkas = one_by_one.farkas;
    candidate.steps += one_by_one.steps;
  }
  return crossover(problem, candidate, accuracy);
}

}  // namespace convex::inline algorithms
